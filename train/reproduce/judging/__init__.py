"""Studies, the rules that judge them, and the ledger of statements."""
