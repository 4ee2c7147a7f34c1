"""What can be said of a loop without simulating it: stationary cost, frequency response, margins."""
