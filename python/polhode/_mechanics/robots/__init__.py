"""Bodies of the links in robot files: URDF, MJCF and SDF."""
