"""Arguments of commands as argparse reads them."""

import argparse

import pytest

from camgeo.cli.arguments import add_out, decimal, name_of, processes


def test_numbers_of_processes():
    assert (processes("1"), processes("150")) == (1, 150)
    for text in ("0", "-1", "1.5", "²", "", "1_0"):
        with pytest.raises(argparse.ArgumentTypeError, match="a whole number from 1"):
            processes(text)


def test_decimals_are_those_of_a_recipe():
    assert (decimal("0.1"), decimal("1/4"), decimal("2*3")) == (0.1, 0.25, 6.0)
    for text in ("1_0", "nan", "", "0x10"):
        with pytest.raises(ValueError, match="not a number"):
            decimal(text)


def test_an_empty_name_is_refused():
    assert name_of("a b") == "a b"
    with pytest.raises(argparse.ArgumentTypeError, match="an empty name"):
        name_of("")


def test_the_folder_has_a_default():
    parser = argparse.ArgumentParser()
    add_out(parser)
    assert parser.parse_args([]).out == "out"
    assert parser.parse_args(["--out", "x"]).out == "x"
