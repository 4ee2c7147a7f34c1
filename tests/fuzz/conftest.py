"""The figures of the fuzz tests at the end of a slow run, whichever processes measured them."""


def pytest_terminal_summary(terminalreporter):
    reports = [*terminalreporter.getreports("passed"), *terminalreporter.getreports("failed")]
    recorded = [dict(report.user_properties) for report in reports if report.when == "call"]
    figures = sorted((each["door"], list(each["examples"].values())) for each in recorded if "door" in each)
    if not figures:
        return
    terminalreporter.section("doors")
    terminalreporter.line(f"{'door':32} {'examples':>8} {'refused':>8} {'as meant':>8} {'faults':>8}")
    for name, counts in [*figures, (f"{len(figures)} doors", [sum(each) for each in zip(*(c for _, c in figures), strict=True)])]:
        terminalreporter.line(f"{name:32} " + " ".join(f"{number:8}" for number in (sum(counts), *counts)))
