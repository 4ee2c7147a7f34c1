"""What the tables and figures are called, in the page's order, for whoever checks a name without importing their studies."""

NAMES: tuple[str, ...] = (
    *("table-2.1", "table-2.2"),
    *(f"table-3.{number}" for number in range(1, 5)),
    *(f"figure-3.{number}" for number in range(2, 25)),
    *(f"figure-5.{number}" for number in range(1, 18)),
    *(f"table-6.{number}" for number in range(1, 5)),
    *(f"figure-6.{number}" for number in range(4, 8)),
    *("graded-strip", "graded-blade", "graded-control", "adaptive-feedback", "recurrent-memory"),
    *("heat-checks", "heat-blade", "heat-control", "heat-pyroelectric", "element-convergence", "element-agreement"),
    *("sizing-front", "joint-placement", "one-patch", "thesis-equations"),
)
"""The thesis' first, then those of what it left to others."""
