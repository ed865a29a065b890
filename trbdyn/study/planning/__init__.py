"""Ask for an accuracy, get the cheapest simulation that has it; `trbdyn.plan`."""

from trbdyn.study.planning.make import plan
from trbdyn.study.planning.proposal import Plan, Row

__all__ = ["Plan", "Row", "plan"]
