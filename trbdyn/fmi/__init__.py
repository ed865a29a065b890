"""A bearing as a unit of FMI 3, which other programs step (extra `trbdyn[fmi]`)."""
