"""Error against run time: what each output form costs at each tolerance, and how far a recipe is from trouble."""

FORMS = ("polyline", "arcs", "spline", "stl")
