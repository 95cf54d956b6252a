"""Cylindrical cams: a translating roller on a groove, a rib or an end of a drum; solids and developments judged."""
