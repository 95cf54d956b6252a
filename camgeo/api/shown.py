"""A recipe's cam for programs that show it, such as the page in a browser: scene, figures, drawings, meshes."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

from camgeo.common.errors import CallError, with_packages

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.api.check import Figures
    from camgeo.api.design import Design
    from camgeo.files.layer_outline import LayerOutline
    from camgeo.files.mesh import Mesh
    from camgeo.motions.stated import StatedMotion
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array

Drawing: TypeAlias = "tuple[str, Sequence[LayerOutline | Array]]"
"""A drawing at true size: its title, and its closed outlines and open lines (n, 2), mm."""


class Shown(ABC):
    """The cam of a recipe as it is shown. Each member raises RecipeErrors where there is no such cam."""

    @abstractmethod
    def picture(self) -> dict[str, Any]:
        """Data of a page that show and move the mechanism, before checks; empty where only `scene` has them."""

    @abstractmethod
    def still(self, at: float = 0.0) -> str:
        """The mechanism as SVG by itself, at a place of its input, in the unit of a page: degrees, or the recipe's."""

    @abstractmethod
    def scene(self) -> dict[str, Any]:
        """Data of a page without files, as of `Design.scene`; `panels` has the HTML of panels of its own."""

    def looks(self) -> tuple[str, str]:
        """Rules of style of the panels of a scene, and code of the players that it names, as on the report's page."""
        return "", ""

    @property
    @abstractmethod
    def figures(self) -> Figures:
        """Figures by name, in the recipe's unit."""

    @abstractmethod
    def motion(self) -> StatedMotion | str:
        """The motion of the first plot, or why nobody states it."""

    @abstractmethod
    def foresee(self, request: FileRequest) -> None:
        """Raise MissingExtraError where a package is missing that makes a file; RecipeErrors for other reasons."""

    @abstractmethod
    def drawings(self, tolerance: float) -> list[Drawing]:
        """Drawings at true size, within a tolerance, mm, or the recipe's where that is less.

        Raises CallError where a failed check leaves none.
        """

    @abstractmethod
    def meshes(self, request: FileRequest) -> list[Mesh]:
        """Meshes, mm, of the solids that a request of a mesh asks for; raises CallError as `drawings` does."""


class ShownCam(Shown):
    """A cam of the core, with its linkage."""

    def __init__(self, recipe: Recipe) -> None:
        """`recipe` is that of the cam."""
        self.recipe = recipe

    def picture(self) -> dict[str, Any]:
        """Data of the mechanism; empty for a linkage, whose poses take nearly all of the time of a scene."""
        from camgeo.report.page import page
        from camgeo.report.page.content import mechanism
        from camgeo.synthesis.design import sketched

        if self.recipe.linkage is not None:
            return {}
        drawn, _, relative = mechanism(self.recipe, sketched(self.recipe))
        return page.picture(self.recipe, drawn, relative, -1 if self.recipe.rotation == "cw" else 1)

    def still(self, at: float = 0.0) -> str:
        """The exact cam with its follower."""
        from camgeo.report.page.content import content
        from camgeo.report.page.svg import still

        scene = content(self.recipe, self._design.exact, ()).scene
        return still(scene, scene.step_at(at), self.recipe.name)

    @cached_property
    def _design(self) -> Design:
        from camgeo.api.design import Design
        from camgeo.common.clock import Clock
        from camgeo.synthesis.design import designed

        with with_packages():
            return Design(self.recipe, designed(self.recipe, Clock()))

    def scene(self) -> dict[str, Any]:
        """`Design.scene`."""
        return dict(self._design.scene())

    @property
    def figures(self) -> Figures:
        """`Design.figures`."""
        return self._design.figures

    def motion(self) -> StatedMotion | str:
        """The motion over the shaft angle."""
        from camgeo.motions.stated import StatedMotion

        recipe, exact = self.recipe, self._design
        if recipe.linkage is not None:
            return "The plot shows what the linkage makes of the motion, which is changed in its boxes."
        source = recipe.cam.stated_motion
        total = recipe.cam.motion_span
        return StatedMotion(
            source,
            total,
            1 if source is None else source.repeats,
            "same" if math.isclose(total, 2.0 * math.pi) else "opposite",
            exact.motion,
            math.degrees(1.0),
            1.0 / recipe.mm if exact.unit == "mm" else math.degrees(1.0),
        )

    def _job(self) -> Job:
        from camgeo.output.job import Job

        if not self._design.exact.contours:
            raise CallError("there is no contour: a check fails")
        return Job.of(self.recipe, self._design.exact)

    def foresee(self, request: FileRequest) -> None:
        """Refuse a file that a run would refuse, by the dispatch of formats."""
        from camgeo.output.dispatch import foresee

        foresee(self._job(), request)

    def drawings(self, tolerance: float) -> list[Drawing]:
        """Contours and openings of each disc."""
        from camgeo.output.part_geometry import contours_of, openings_of, rim_of
        from camgeo.recipe.export import FileRequest

        job, recipe = self._job(), self.recipe
        found: list[Drawing] = []
        for disc, single in zip(job.design.discs, job.single, strict=True):
            with job.refusals(FileRequest("dxf")):
                contours = single.outlines("arcs", min(recipe.export.tolerance, tolerance))
            outlines = [*contours_of(single.design, contours), *rim_of(single.body), *openings_of(single.body)]
            found.append((f"{recipe.name} {disc.name}".strip(), outlines))
        return found

    def meshes(self, request: FileRequest) -> list[Mesh]:
        """A mesh of each disc, in its place on the shaft."""
        from camgeo.output.solid import cam_meshes, foresee

        job = self._job()
        with job.refusals(request):
            foresee(job, request)
        return [disc.standing for disc in cam_meshes(job, request)]
