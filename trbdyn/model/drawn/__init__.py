"""Cages from drawings: STEP and STL files, read by Gmsh and Open CASCADE (the extra ``trbdyn[cad]``)."""
