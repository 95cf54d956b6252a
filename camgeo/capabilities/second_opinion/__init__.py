"""A second opinion on files: what ezdxf, shapely, trimesh and manifold3d say of them, beside the judge's own checks."""

from camgeo.registry.label import Label

LABEL = Label(
    rank=70,
    option="have ezdxf, shapely, trimesh and manifold3d look at the files too (extra `check`)",
)
