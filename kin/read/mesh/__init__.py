"""Meshes: STL and 3MF as upright prisms."""
