"""Tables as others write them: sound ones are followed without a remark on a row, a wrong row of others is named.

`python tests/law/sources/test_written_tables.py [SEED [COUNT]]` counts both kinds among 300 tables each.
"""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2]))

from support.written_tables import Written, corpus

from kin.law.normalised import IntentError
from kin.law.sources.motion import Motion
from kin.law.sources.table import from_table

COUNT, QUICK, SLOW = 300, 2, 15


def made(table: Written) -> Motion | str:
    """The motion, or why the table is refused."""
    try:
        return from_table(table.rows, None)
    except IntentError as error:
        return error.message


def counted(count: int, seed: int) -> tuple[list[str], list[str], list[str]]:
    """Sound tables that are refused, sound ones with a remark on rows, and spoilt ones whose wrong row is not named."""
    refused, remarked, passed = [], [], []
    for sound, spoilt in corpus(count, seed):
        motion, other = made(sound), made(spoilt)
        if isinstance(motion, str):
            refused.append(f"{sound.about}: {motion}")
        else:
            named = [remark for remark in motion.kept.remarks if remark.name in {"table-row", "table-noise"}]
            remarked += [f"{sound.about}: {remark.sentence}" for remark in named[:1]]
        if isinstance(other, str) or not spoilt.is_named(other):
            lines = [i + 1 for i in spoilt.wrong]
            passed.append(f"{spoilt.about}: {spoilt.harm} in line {lines}: {other if isinstance(other, str) else ''}")
    return refused, remarked, passed


@pytest.mark.slow
@pytest.mark.parametrize(("count", "seed", "most"), [(QUICK, 7, 0), pytest.param(SLOW, 8, 1, marks=pytest.mark.slow)])
def test_sound_tables_are_followed_and_a_wrong_row_is_named(count, seed, most):
    refused, remarked, passed = counted(count, seed)
    assert refused == []
    assert remarked == []
    assert len(passed) <= most, passed


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:]]
    count = numbers[1] if numbers[1:] else COUNT
    for what, tables in zip(
        ("sound, refused", "sound, remarked", "spoilt, not named"), counted(count, *(numbers[:1] or [1])), strict=True
    ):
        print(f"{what}: {len(tables)} of {count}", *tables, sep="\n  ")
