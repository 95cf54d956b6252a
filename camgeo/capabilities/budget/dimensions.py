"""The dimensions that a budget may give a tolerance: their words, their units, and the cams that have them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable
    from collections.abc import Set as AbstractSet

PROFILE, BORE, ANGLE, GUIDE = "profile", "bore", "angle", "guide"
CONTOUR = "contour"  # in shares: the error of a contour that is not exact
CONJUGATE, LINKAGE = "two discs", "linkage"  # traits


class Dimension(NamedTuple):
    """A dimension that a budget may give a tolerance.

    `about` describes it in words. `applies` takes the traits of a cam and returns whether the cam has the dimension.
    `angle` is whether it is an angle, else it is a length. `radius` is whether its tolerance is the radius of a circle
    within which a point may stand, else it is plus and minus.
    """

    about: str
    applies: Callable[[AbstractSet[str]], bool]
    angle: bool = False
    radius: bool = False


def traits(offers: AbstractSet[str], discs: int, linkage: str) -> frozenset[str]:
    """Traits that select the dimensions of a budget.

    For a linkage of a kind `linkage` they are LINKAGE and that kind. Where that is empty, they are the words `offers`
    of the cam's arrangement, such as roller, stem or arm, and CONJUGATE for more than one disc.
    """
    if linkage:
        return frozenset({LINKAGE, linkage})
    return frozenset(offers) | ({CONJUGATE} if discs > 1 else frozenset())


def _has(*names: str) -> Callable[[AbstractSet[str]], bool]:
    return lambda traits: traits >= set(names)


def _always(_: AbstractSet[str]) -> bool:
    return True


def _faces(traits: AbstractSet[str]) -> bool:
    return not traits.isdisjoint({"face", LINKAGE}) or ("swings" in traits and "roller" not in traits)


def _one_radius(traits: AbstractSet[str]) -> bool:
    return "roller" in traits and not traits.isdisjoint({"stem", "arm"})


def _two_radii(traits: AbstractSet[str]) -> bool:
    return "roller" in traits and traits.isdisjoint({"stem", "arm"})


def _two_on_a_stem(traits: AbstractSet[str]) -> bool:
    return not traits.isdisjoint({"plate", LINKAGE}) or ("led" in traits and _two_radii(traits))


def _has_pivot(traits: AbstractSet[str]) -> bool:
    return not traits.isdisjoint({"arm", "swings", "four-bar", "inverted-slider-crank"})


DIMENSIONS = {
    PROFILE: Dimension("the cam's profile along its normal", _always),
    ANGLE: Dimension("the cam on the shaft", _always, angle=True),
    BORE: Dimension("the profile against the bore, in the cam", _always, radius=True),
    "shaft": Dimension("the shaft against the follower's guide or pivot", _always, radius=True),
    "index": Dimension("disc 2 against disc 1", _has(CONJUGATE), angle=True),
    GUIDE: Dimension("the direction of the stem in its guide", _has("led"), angle=True),
    "face": Dimension("squareness of a flat face", _faces, angle=True),
    "pivot": Dimension("the pivot of the arm, or of the linkage", _has_pivot, radius=True),
    "breadth": Dimension("between the faces, or the rollers' centres, of a frame", _two_on_a_stem),
    "follower.radius": Dimension("radius of the roller or shoe", _one_radius),
    "follower.offset": Dimension("eccentricity of the stem", _has("led")),
    "follower.tilt": Dimension("direction of a flat face on a stem", _has("stem-face"), angle=True),
    "follower.arm.length": Dimension("length of the arm", _has("arm", "roller")),
    "follower.arm.pivot": Dimension("distance of the pivot from the shaft", _has("arm")),
    "follower.arm.face": Dimension("how near the shaft a face on an arm stands", _has("arm", "face")),
    "conjugate.radius": Dimension("radius of the second roller", _has(CONJUGATE, "roller")),
    "conjugate.distance": Dimension("between the rollers' centres or the faces of a stem", _has(CONJUGATE, "led")),
    "conjugate.length": Dimension("length of the second arm", _has(CONJUGATE, "arm")),
    "conjugate.angle": Dimension("between the arms of a bell crank", _has(CONJUGATE, "arm"), angle=True),
    "roller_radius": Dimension("radius of each of two rollers", _two_radii),
    "arm": Dimension("length of each of two arms", _has("swings", "roller")),
    "spread": Dimension("each of two arms against their bisector", _has("swings", "roller"), angle=True),
    "linkage.ground": Dimension("distance of the linkage's pivot from the shaft", _has_pivot),
    "linkage.coupler": Dimension(
        "from the frame to the joint", lambda traits: not traits.isdisjoint({"four-bar", "slider-crank"})
    ),
    "linkage.rocker": Dimension(
        "length of the rocker", lambda traits: not traits.isdisjoint({"four-bar", "inverted-slider-crank"})
    ),
    "linkage.offset": Dimension("height of the slide's line", _has("slider-crank")),
    "linkage.joint_offset": Dimension("of the joint from the frame's mid-line", _has(LINKAGE)),
    "joints": Dimension("play of each joint of the linkage", _has(LINKAGE), radius=True),
}


def dimension_names(traits: AbstractSet[str]) -> tuple[str, ...]:
    """Words of the dimensions that a cam of these traits has, in the order of `DIMENSIONS`."""
    return tuple(
        name
        for name, dimension in DIMENSIONS.items()
        if dimension.applies(traits) and (LINKAGE in traits or not name.startswith("linkage."))
    )
