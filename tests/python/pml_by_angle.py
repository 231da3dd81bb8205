"""Runs validation/pml/{small,large}.in through gprMax in double precision and prints the echo of its boundary by angle.

python tests/python/pml_by_angle.py > validation/pml/gprmax.csv
"""
import math, os, subprocess, sys, tempfile
import h5py
import numpy as np

here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "validation", "pml")
with tempfile.TemporaryDirectory() as folder:
    runs = {}
    for name in ("small", "large"):
        out = os.path.join(folder, name + ".h5")
        command = [sys.executable, "-m", "gprMax", os.path.join(here, name + ".in"), "-o", out, "-cpu_precision", "double"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with h5py.File(out) as file:
            count = int(file.attrs["nrx"])
            position = [file[f"rxs/rx{n}"].attrs["Position"] for n in range(1, count + 1)]
            runs[name] = [file[f"rxs/rx{n}/Ez"][:] for n in range(1, count + 1)], position
print("angle_degrees,echo_db")
(small, places), (large, _) = runs["small"], runs["large"]
for n, trace in enumerate(small):
    angle = math.degrees(math.atan2(places[n][0] - places[0][0], 0.08))
    echo = np.abs(trace - large[n]).max() / np.abs(large[n + len(small)]).max()
    print(f"{angle:.2f},{20 * math.log10(echo):.3f}")
