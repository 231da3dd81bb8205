"""Draws an output file with gprMax's own plot_Ascan, without a screen.

Usage: plot_ascan.py FILE
"""

import runpy
import sys

import matplotlib

matplotlib.use("Agg")
sys.argv = ["plot_Ascan", sys.argv[1]]
runpy.run_module("gprMax.toolboxes.Plotting.plot_Ascan", run_name="__main__")
