"""The keys of the follower train whose dynamics are asked for."""

from __future__ import annotations

from camgeo.recipe.spec import MOST, Field, Kind, Table, length

_MOST = MOST**2  # of figures in SI: a bound against slips

DYNAMICS = Table(
    (
        Field(
            "mass",
            Kind.NUMBER,
            "mass that the contact drives, kg; where the follower turns its moment of inertia, kg m²",
            required=True,
            above=0,
            at_most=_MOST,
        ),
        Field(
            "damping",
            Kind.NUMBER,
            "damping of the contact or train, N s/m; N m s/rad where it turns",
            default="0",
            at_least=0,
            at_most=_MOST,
        ),
        Field(
            "stiffness",
            Kind.NUMBER,
            "stiffness of the contact or train, N/m; N m/rad where it turns",
            required=True,
            above=0,
            at_most=_MOST,
        ),
        Field(
            "preload",
            Kind.NUMBER,
            "force of the spring that holds the follower on the cam, N, at its lowest; N m where it turns",
            above=0,
            at_most=_MOST,
        ),
        length("play", "play between the two faces or rollers that hold the cam, at the contact, instead of a spring"),
        Field(
            "rate",
            Kind.NUMBER,
            "rate of the preload spring, N/m; N m/rad where it turns",
            default="0",
            at_least=0,
            at_most=_MOST,
        ),
        Field("rpm", Kind.NUMBER, "speed of the shaft, turns a minute", required=True, above=0, at_most=MOST),
    ),
    alternatives=(("preload", ()), ("play", ())),
)
