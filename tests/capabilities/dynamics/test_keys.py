"""A coil spring by its own figures, and forces of a rigid follower beside an elastic train's float.

Holds: camgeo.capabilities.dynamics.measure, camgeo.capabilities.dynamics.figures.
"""

from typing import Any

import pytest

import camgeo
from camgeo.schema.errors import RecipeErrors

LOBE = """\
cam:
  kind: disc
  base_radius: 22
  follower: {kind: flat}
  motion: {lobe: {lift: 8.2, half: 68, powers: [2, 8, 14, 20, 26], nose: 180}}
part: {thickness: 14}
verify: {angles: 90}
"""
COIL = "spring: {seat_length: 40, free_length: 48, rate: 30 N/mm, solid_length: 28}"
LOADS = "spring: {seat_length: 40, loads: [[32, 480 N], [44, 120 N]], solid_length: 28}"
PLAIN = "preload: 240, rate: 30000"


def report(train: str, limits: str = "") -> dict[str, Any]:
    bounds = f"limits: {{{limits}}}\n" if limits else ""
    return dict(camgeo.check(camgeo.load(f"{LOBE}dynamics: {{mass: 0.12, rpm: 3000, {train}}}\n{bounds}")))


def measured(train: str, *figures: str) -> list[float]:
    limits = ", ".join(f"{name}: {{at_least: -1e9}}" for name in figures)
    found = {check["name"]: check["value"] for check in report(train, limits)["checks"]}
    return [found[f"limit:{name}"] for name in figures]


@pytest.mark.thin(2)
@pytest.mark.parametrize("spring", [COIL, LOADS])
def test_seat_load_open_load_and_coil_bind(spring: str) -> None:
    """30 N/mm over 8 mm, and over 8.2 mm more; 40 - 8.2 - 28 mm are left."""
    found = measured(spring, "spring-seat-load", "spring-open-load", "coil-bind")
    assert found == pytest.approx([240.0, 486.0, 3.8], rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("more", ["", ", stiffness: 8.0e6, damping: 60"])
def test_a_spring_is_the_preload_and_the_rate_that_it_makes(more: str) -> None:
    own, plain = (report(spring + more) for spring in (COIL, PLAIN))
    for section in ("forces", "dynamics"):
        assert own.get(section) == plain.get(section)
    assert [(check["name"], check["value"]) for check in own["checks"]] == [
        (check["name"], check["value"]) for check in plain["checks"]
    ]


def test_inches_and_pounds_are_the_same_spring() -> None:
    text = LOBE.replace("22", "22/25.4").replace("8.2", "8.2/25.4").replace("14}", "14/25.4}")
    spring = "spring: {seat_length: 40/25.4, free_length: 48/25.4, rate: 30 N/mm, solid_length: 28/25.4}"
    train = f"dynamics: {{mass: 0.12, rpm: 3000, {spring}}}\n"
    made = camgeo.check(camgeo.load(f"units: inch\n{text}{train}limits: {{spring-open-load: {{at_most: 500}}}}\n"))
    (check,) = [check for check in made.checks if check.name == "limit:spring-open-load"]
    assert check.value == pytest.approx(486.0, rel=1e-9)


@pytest.mark.slow
def test_pressure_float_and_transient_come_from_one_train() -> None:
    """Forces and pressure are those of the rigid train, float and impacts those of the elastic one."""
    elastic = "stiffness: 8.0e6, damping: 60, transient: true"
    one = report(f"{COIL}, {elastic}, material: steel", "contact-pressure: {at_most: 700}, least-force: {at_least: 1}")
    rigid, alone = report(f"{COIL}, material: steel"), report(f"{COIL}, {elastic}")
    assert one["forces"] == rigid["forces"]
    assert one["dynamics"] == alone["dynamics"]
    assert one["ok"]
    floats = [check["value"] for check in one["checks"] if check["name"] == "float"]
    assert floats == [check["value"] for check in alone["checks"] if check["name"] == "float"]
    assert "forces" not in alone


FAULTS = [
    (f"{COIL}, preload: 9", "dynamics.spring: cannot be combined with preload; give exactly one of", COIL),
    (f"{COIL}, rate: 9", "dynamics.rate: cannot be combined with spring; leave one of the two out", COIL),
    (
        "spring: {seat_length: 50, free_length: 48, rate: 30 N/mm}",
        "dynamics.spring.seat_length: the spring is slack there; give less than 48 mm",
        "spring: {seat_length: 47, free_length: 48, rate: 30 N/mm}",
    ),
    (
        COIL.replace("28", "41"),
        "dynamics.spring.solid_length: its coils touch before it moves; give less than 40 mm",
        COIL.replace("28", "39"),
    ),
    (
        "spring: {seat_length: 40, rate: 30 N/mm}",
        "dynamics.spring.free_length: missing, needed with rate",
        COIL,
    ),
    (
        LOADS.replace("480", "100"),
        "dynamics.spring.loads: the force does not grow as it is pressed; give the greater at the shorter",
        LOADS,
    ),
    (
        LOADS.replace("[32, 480 N]", "480"),
        "dynamics.spring.loads[0]: not a length with its force, given 480; give [40, 250]",
        LOADS,
    ),
    (
        "spring: {seat_length: 40, loads: [[32, 480]]}",
        "dynamics.spring.loads: one load tells no rate; give two lengths with their forces",
        LOADS,
    ),
    (
        "backlash: 0.02, stiffness: 8.0e6, material: steel",
        "dynamics.material: belongs to a train without stiffness; leave stiffness out, or this",
        f"{COIL}, stiffness: 8.0e6, material: steel",
    ),
]


def test_faults_of_a_spring() -> None:
    for train, message, _ in FAULTS:
        with pytest.raises(RecipeErrors) as caught:
            report(train)
        assert message in str(caught.value)


@pytest.mark.thin(8)
@pytest.mark.parametrize("remedy", sorted({remedy for *_, remedy in FAULTS}))
def test_what_is_told_of_a_spring_mends_it(remedy: str) -> None:
    report(remedy)


def test_an_arm_has_no_coil_spring_on_a_stem() -> None:
    arm = "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 8, arm: {length: 60, pivot: 70}}, "
    arm += "motion: [{rise: 10, over: 120, law: cycloidal}, {return: 10, over: 120, law: cycloidal}, {dwell: 120}]}\n"
    with pytest.raises(RecipeErrors, match="a coil spring on a stem, and there is none; give preload and rate"):
        camgeo.load(f"{arm}dynamics: {{mass: 0.01, rpm: 60, {COIL}}}\n")
    camgeo.load(f"{arm}dynamics: {{mass: 0.01, rpm: 60, preload: 2, rate: 5}}\n")
