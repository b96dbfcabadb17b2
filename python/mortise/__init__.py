"""Results of mortise runs."""
from .reading import Run, State, table

__all__ = ["Run", "State", "table"]
