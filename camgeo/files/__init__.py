"""What files are made of: outlines on layers, meshes and solids, and the numbers that formats hold."""
