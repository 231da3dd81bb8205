"""The scene of `cargo bench --bench dem` for Kratos with BROF.

Install: python3 -m venv kratos; kratos/bin/pip install KratosMultiphysics==10.4.4 KratosDEMApplication==10.4.4
Usage: python dem_kratos.py bed.csv STEPS THREADS WIDE   (bed.csv: x, y, z, radius in m; WIDE: m, or none)
Prints one line, `loop SECONDS`.
"""

import json
import os
import sys
import tempfile
import time

BED, STEPS, THREADS, WIDE = sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4]
os.environ["OMP_NUM_THREADS"] = THREADS

import KratosMultiphysics as Kratos  # noqa: E402
from KratosMultiphysics.DEMApplication.DEM_analysis_stage import DEMAnalysisStage  # noqa: E402

DT = 5e-6
GRAINS = [tuple(map(float, line.split(","))) for line in open(BED)]


def spheres(path):
    with open(path, "w") as file:
        file.write("Begin ModelPartData\nEnd ModelPartData\nBegin Properties 0\nEnd Properties\nBegin Nodes\n")
        for n, (x, y, z, _) in enumerate(GRAINS, 1):
            file.write(f"{n} {x!r} {y!r} {z!r}\n")
        file.write("End Nodes\nBegin Elements SphericParticle3D\n")
        for n in range(1, len(GRAINS) + 1):
            file.write(f"{n} 0 {n}\n")
        file.write("End Elements\nBegin NodalData RADIUS\n")
        for n, (_, _, _, radius) in enumerate(GRAINS, 1):
            file.write(f"{n} 0 {radius!r}\n")
        file.write("End NodalData\nBegin SubModelPart bed\nBegin SubModelPartNodes\n")
        file.writelines(f"{n}\n" for n in range(1, len(GRAINS) + 1))
        file.write("End SubModelPartNodes\nBegin SubModelPartElements\n")
        file.writelines(f"{n}\n" for n in range(1, len(GRAINS) + 1))
        file.write("End SubModelPartElements\nEnd SubModelPart\n")


def walls(path):
    with open(path, "w") as file:
        file.write("Begin ModelPartData\nEnd ModelPartData\nBegin Properties 0\nEnd Properties\nBegin Nodes\n")
        wide, high = (0.0, 0.0) if WIDE == "none" else (float(WIDE), 6.0)
        corners = [(x, y, z) for z in (0.0, high) for y in (0.0, wide) for x in (0.0, wide)]
        if WIDE != "none":
            for n, (x, y, z) in enumerate(corners, 1):
                file.write(f"{n} {x} {y} {z}\n")
        file.write("End Nodes\n")
        if WIDE == "none":
            return
        faces = [(1, 2, 4, 3), (1, 5, 6, 2), (2, 6, 8, 4), (4, 8, 7, 3), (3, 7, 5, 1)]
        triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
        file.write("Begin Conditions RigidFace3D3N\n")
        for n, (a, b, c) in enumerate(triangles, 1):
            file.write(f"{n} 0 {a} {b} {c}\n")
        file.write("End Conditions\nBegin SubModelPart box\nBegin SubModelPartNodes\n")
        file.writelines(f"{n}\n" for n in range(1, 9))
        file.write("End SubModelPartNodes\nBegin SubModelPartConditions\n")
        file.writelines(f"{n}\n" for n in range(1, len(triangles) + 1))
        file.write("End SubModelPartConditions\nEnd SubModelPart\n")


def empty(path):
    open(path, "w").write("Begin ModelPartData\nEnd ModelPartData\n")


MATERIALS = {
    "materials": [
        {"material_name": "stone", "material_id": 1, "Variables": {
            "PARTICLE_DENSITY": 2700.0, "YOUNG_MODULUS": 17.7e9, "POISSON_RATIO": 0.18}},
        {"material_name": "wall", "material_id": 2, "Variables": {
            "YOUNG_MODULUS": 17.7e9, "POISSON_RATIO": 0.18, "COMPUTE_WEAR": False}},
    ],
    "material_relations": [
        {"material_names_list": ["stone", other], "material_ids_list": [1, number], "Variables": {
            "COEFFICIENT_OF_RESTITUTION": 0.4, "STATIC_FRICTION": 0.6, "DYNAMIC_FRICTION": 0.6,
            "FRICTION_DECAY": 500.0, "ROLLING_FRICTION": 0.25, "ROLLING_FRICTION_WITH_WALLS": 0.25,
            "DEM_DISCONTINUUM_CONSTITUTIVE_LAW_NAME": "DEM_D_Hertz_viscous_Coulomb",
            "DEM_ROLLING_FRICTION_MODEL_NAME": "DEMRollingFrictionModelBounded"}}
        for other, number in (("stone", 1), ("wall", 2))
    ],
    "material_assignation_table": [["SpheresPart.bed", "stone"], ["RigidFacePart", "wall"]],
}


class Timed(DEMAnalysisStage):
    """Times the steps and nothing else."""

    def RunSolutionLoop(self):
        begin = time.perf_counter()
        for _ in range(STEPS):
            self.time = self._AdvanceTime()
            self.InitializeSolutionStep()
            self._GetSolver().Predict()
            self._GetSolver().SolveSolutionStep()
            self.FinalizeSolutionStep()
        print("loop", time.perf_counter() - begin, flush=True)

    def PrintResultsForGid(self, time):
        pass


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    spheres("bedDEM.mdpa")
    walls("bedDEM_FEM_boundary.mdpa")
    empty("bedDEM_Clusters.mdpa")
    empty("bedDEM_Inlet.mdpa")
    json.dump(MATERIALS, open("materials.json", "w"))
    parameters = {
        "problem_name": "bed",
        "Dimension": 3,
        "PeriodicDomainOption": False,
        "BoundingBoxOption": False,
        "AutomaticBoundingBoxOption": False,
        "dem_inlet_option": False,
        "GravityX": 0.0, "GravityY": 0.0, "GravityZ": -9.81,
        "RotationOption": True,
        "CleanIndentationsOption": False,
        "solver_settings": {
            "RemoveBallsInitiallyTouchingWalls": False,
            "strategy": "sphere_strategy",
            "material_import_settings": {"materials_filename": "materials.json"},
        },
        "DeltaOption": "Absolute",
        "SearchTolerance": 0.0005,
        "TranslationalIntegrationScheme": "Symplectic_Euler",
        "RotationalIntegrationScheme": "Direct_Integration",
        "MaxTimeStep": DT,
        "FinalTime": 1e9,
        "NeighbourSearchFrequency": 10,
        "ElementType": "SphericPartDEMElement3D",
        "OutputTimeStep": 1e9,
        "GraphExportFreq": 1e9,
        "do_print_results_option": False,
    }
    Timed(Kratos.Model(), Kratos.Parameters(json.dumps(parameters))).Run()
