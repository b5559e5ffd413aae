"""Reports: one HTML file per result that opens offline, and the paper's figures."""

from plantar.report.content import Cell, Column, Figure, Section, Table
from plantar.report.dynamics import write_dynamics_report
from plantar.report.feet import write_feet_report

__all__ = ["Cell", "Column", "Figure", "Section", "Table", "write_dynamics_report", "write_feet_report"]
