"""Prints what h5py finds in an output file, as JSON: attributes, and sum and peak of each dataset.

Usage: read_output.py FILE
"""

import json
import sys

import h5py
import numpy as np

found = {}


def plain(value):
    value = np.asarray(value)
    return value.tolist() if value.dtype.kind in "fiub" else str(value)


def visit(name, item):
    for key, value in item.attrs.items():
        found[f"{name}@{key}"] = plain(value)
    if isinstance(item, h5py.Dataset) and item.dtype.kind in "fi":
        values = item[...].astype(float)
        found[name] = {"shape": list(item.shape), "type": str(item.dtype), "peak": float(np.abs(values).max()), "sum": float(values.sum())}


with h5py.File(sys.argv[1], "r") as file:
    visit("", file)
    file.visititems(visit)
json.dump(found, sys.stdout)
