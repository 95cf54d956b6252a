"""Cylindrical cams: files and measured points of a drum are judged, and drums of any origin are followed."""
