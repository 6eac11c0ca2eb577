"""Reports of runs: text, numbers and netCDF files."""
