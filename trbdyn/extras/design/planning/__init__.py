"""Ask for an accuracy, get the cheapest simulation that has it; `trbdyn.plan`."""

from trbdyn.extras.design.planning.make import plan
from trbdyn.extras.design.planning.proposal import Plan, Row

__all__ = ["Plan", "Row", "plan"]
