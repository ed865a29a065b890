"""Cages from drawings, STEP and STL files read by Gmsh and Open CASCADE, and profiles from traces and DXF files (the extra
``trbdyn[cad]``).
"""
