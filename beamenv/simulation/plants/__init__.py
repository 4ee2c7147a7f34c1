"""Which plant a blade has: banks, run-ups, plants over a range of speeds."""
