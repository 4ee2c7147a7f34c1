"""Sections: stiffness and inertia of a closed contour of walls."""
