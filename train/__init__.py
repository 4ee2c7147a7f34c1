"""Training, comparison and benchmark of controllers, the thesis reproduced, and the command line."""
