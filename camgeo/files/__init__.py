"""Contents of files: outlines on layers, meshes and solids, and the precision of formats."""
