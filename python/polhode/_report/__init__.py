"""What is known of a run: text, numbers and netCDF files."""
