"""In CI a test is not skipped because something is missing that `setup.sh dev` brings: it fails."""

import os

#: What `setup.sh dev` does not bring: tests that need it are skipped in CI, too, and named at the end of the run.
NOT_BROUGHT = ("FreeCAD", "is not at hand (shared/data/")


def in_ci():
    """Whether this run says of itself that it is one of CI."""
    return os.environ.get("CI", "").lower() not in ("", "0", "false")


def strict(report):
    """The report of a test or of a module; failed in CI where it was skipped, unless for what is not brought."""
    if report.skipped and not hasattr(report, "wasxfail") and in_ci():
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
        if not any(each in reason for each in NOT_BROUGHT):
            report.outcome = "failed"
            report.longrepr = f"{reason}\nNothing that setup.sh dev brings may be missing in CI (tests/support/skips.py)."
    return report
