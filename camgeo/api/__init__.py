"""The library as its users see it: recipes read, cams designed, files made and judged; `camgeo` names all of it."""
