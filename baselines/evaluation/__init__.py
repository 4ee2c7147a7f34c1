"""Any controller on any environment: episodes, metrics, intervals."""
