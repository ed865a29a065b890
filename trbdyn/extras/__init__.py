"""Extras: what answers further questions than a run does. Each folder is one of them; it imports the core, and no other extra but
`study`. Users call them by the names of `trbdyn`. The core runs without this folder.
"""
