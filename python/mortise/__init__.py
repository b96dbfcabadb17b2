"""Results of mortise runs: read them (reading), make them (running)."""
from .reading import Run, State, Table, labelled, table
from .running import WrongInput, compare, run, sweep

__all__ = ["Run", "State", "Table", "WrongInput", "compare", "labelled", "run", "sweep", "table"]
