"""Which plant a blade has: banks, spin-ups, plants over a range of speeds."""
