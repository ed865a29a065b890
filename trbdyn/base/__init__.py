"""What every other layer stands on: checked input models, safe writing of files, the version."""
