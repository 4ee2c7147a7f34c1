"""A blade as a user describes it: configuration, presets, files, layouts of its patches; and what is built from it."""
