"""A second opinion on files: checks by ezdxf, shapely, trimesh and manifold3d, beside the judge's own."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=70,
    option="have ezdxf, shapely, trimesh and manifold3d look at the files too (extra `check`)",
)
