"""Exchange with other programs: units of FMI 3, which they step (`trbdyn[fmi]`), and REXS files of gear units."""
