"""How arguments are read: what each may be (``kinds``, ``numbers``), tables of them (``reading``), files, and the one refusal.

The rules, the same for every argument, dictionary and file:

- A number is an ``int``, a ``float``, or NumPy's, also as an array of no dimensions, and finite. It is never a bool nor a string.
- A count is an integer, Python's or NumPy's, or a float without a fraction: 11.0 is 11, and 11.5 is refused.
- True and false are ``True``, ``False`` and NumPy's ``bool_``; 1, "yes" and "no" are refused.
- A sequence is a list, a tuple or a one-dimensional array, never a string. A range is two numbers that do not fall, and one
  number means both ends.
- The keys of a table are the names of its fields; an unknown one is refused, and the known ones are listed.
- A table may be partial. What it leaves out stays as it stood: that of the preset or scenario it departs from, also within
  tables of tables, and a material's as well.
- A constructor takes objects: tables are for ``blade_config``, ``scenario``, ``from_dict`` and files.
- What is refused raises a ``ValueError`` of one sentence: the argument with its path, its value, what is allowed.
"""

from beamenv.configuration.composite import Items, Variant, Variants
from beamenv.configuration.heeded import check_heeded
from beamenv.configuration.kinds import Choice, FileName, Flag, Instance, NameOrFile, Table, Text, Texts
from beamenv.configuration.numbers import Count, Natural, Number, Numbers, Patches, Points, Positive, Range, Real, Share, Whole
from beamenv.configuration.reading import checked, checked_table, configuration, read
from beamenv.configuration.sentence import Refused, clause, shown, unknown_name

__all__ = [
    "Choice",
    "Count",
    "FileName",
    "Flag",
    "Instance",
    "Items",
    "NameOrFile",
    "Natural",
    "Number",
    "Numbers",
    "Patches",
    "Points",
    "Positive",
    "Range",
    "Real",
    "Refused",
    "Share",
    "Table",
    "Text",
    "Texts",
    "Variant",
    "Variants",
    "Whole",
    "check_heeded",
    "checked",
    "checked_table",
    "clause",
    "configuration",
    "read",
    "shown",
    "unknown_name",
]
