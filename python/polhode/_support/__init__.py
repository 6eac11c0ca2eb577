"""What every other folder uses: arrays, files, optional libraries and memory."""
