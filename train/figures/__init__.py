"""One vocabulary of figures, and two renderers: ``paper`` makes PNG with matplotlib, ``screen`` makes plotly's dictionaries."""
