"""Kratos: dual mortar contact with an augmented Lagrangian, frictionless; quadrilaterals and hexahedra of order 1, total Lagrangian.

Its plane-strain law is mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2: compared with this program's answer of that law. The criterion that balances top and bottom never reports
convergence, so the balance itself is asked for."""
import json
import pathlib
import tempfile

import KratosMultiphysics as kratos
import KratosMultiphysics.ContactStructuralMechanicsApplication  # noqa: F401
import KratosMultiphysics.LinearSolversApplication  # noqa: F401
import numpy as np
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis

import meshes
from scenes import SCENES, options, report

args = options(__doc__, n=8, grade=0.0, steps=1, iterations=15)
kratos.Logger.GetDefaultOutput().SetSeverity(kratos.Logger.Severity.WARNING)
scene = SCENES[args.scene]
dim, upright = scene.dim, scene.dim - 1
points, cells = meshes.generate(scene, args.n, 1, args.grade)
nodes = {name: meshes.corners(c) for name, c in cells.items()}
used = {name: np.unique(c) for name, c in nodes.items()}
flat = {"upper": 1, "lower": -scene.height}
held = {name: used[name][abs(points[used[name], upright] - flat[name]) < 1e-9] for name in nodes}
loose = np.setdiff1d(np.concatenate(list(used.values())), np.concatenate(list(held.values())))
FACES = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]  # of a hexahedron, normals outward


def block(kind, lines):
    return [f"Begin {kind}", *lines, f"End {kind.split()[0]}"]


def part(name, members, elements=(), conditions=()):
    lists = (("Nodes", [k + 1 for k in members]), ("Elements", elements), ("Conditions", conditions))
    return block(f"SubModelPart {name}", [line for kind, values in lists for line in block(f"SubModelPart{kind}", map(str, values))])


text = block("ModelPartData", []) + [line for k in range(3) for line in block(f"Properties {k}", [])]
text += block("Nodes", [f"{k + 1} " + " ".join(f"{v:.15g}" for v in (*points[k], 0)[:3]) for u in used.values() for k in u])
parts, first, on, condition = [], 1, {}, 1
for number, (name, c) in enumerate(nodes.items(), 1):
    text += block(f"Elements TotalLagrangianElement{dim}D{2**dim}N", [f"{first + k} {number} " + " ".join(map(str, cell + 1)) for k, cell in enumerate(c)])
    parts += part(f"body_{name}", used[name], range(first, first + len(c)))
    first += len(c)
    faces = [[c[e][k] for k in ([f, (f + 1) % 4] if dim == 2 else FACES[f])] for e, f, _ in meshes.faces(cells[name], points, meshes.on_arc if name == "upper" else meshes.on_face)]
    text += block(f"Conditions {'LineCondition2D2N' if dim == 2 else 'SurfaceCondition3D4N'}", [f"{condition + k} 0 " + " ".join(str(v + 1) for v in f) for k, f in enumerate(faces)])
    on[name] = np.unique(faces), range(condition, condition + len(faces))
    condition += len(faces)
parts += part("top", held["upper"]) + part("bottom", held["lower"])
for axis in range(upright):
    parts += part(f"axis{axis}", loose[abs(points[loose, axis]) < 1e-9])
parts += part("contact", np.union1d(on["upper"][0], on["lower"][0]), (), range(1, condition)) + part("slave", on["upper"][0], (), on["upper"][1])


def fix(name, axes, value=(0, 0, 0)):
    return {"python_module": "assign_vector_variable_process", "kratos_module": "KratosMultiphysics", "process_name": "AssignVectorVariableProcess",
            "Parameters": {"model_part_name": f"Structure.{name}", "variable_name": "DISPLACEMENT", "constrained": axes, "value": list(value)}}


with tempfile.TemporaryDirectory() as scratch:
    scratch = pathlib.Path(scratch)
    (scratch / "mesh.mdpa").write_text("\n".join(text + parts) + "\n")
    law = "HyperElasticPlaneStrain2DLaw" if dim == 2 else "HyperElastic3DLaw"
    (scratch / "materials.json").write_text(json.dumps({"properties": [
        {"model_part_name": f"Structure.body_{name}", "properties_id": k, "Material": {"constitutive_law": {"name": law}, "Tables": {}, "Variables": {
            "YOUNG_MODULUS": scene.E, "POISSON_RATIO": scene.nu, "DENSITY": 1.0, "THICKNESS": 1.0}}} for k, name in enumerate(nodes, 1)]}))
    down = [0.0, 0.0, 0.0]
    down[upright] = f"-{scene.press}*t"
    settings = {
        "problem_data": {"problem_name": "scene", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1 - 1e-6, "echo_level": 0},
        "solver_settings": {
            "solver_type": "Static", "model_part_name": "Structure", "domain_size": dim, "echo_level": 0, "analysis_type": "non_linear",
            "model_import_settings": {"input_type": "mdpa", "input_filename": str(scratch / "mesh")}, "material_import_settings": {"materials_filename": str(scratch / "materials.json")},
            "time_stepping": {"time_step": 1 / args.steps}, "compute_reactions": True, "reform_dofs_at_each_step": True, "clear_storage": True,
            "contact_settings": {"mortar_type": "ALMContactFrictionless", "fancy_convergence_criterion": False, "silent_strategy": True},
            "convergence_criterion": "contact_and_criterion", "displacement_relative_tolerance": 1e-6, "displacement_absolute_tolerance": 1e-12,
            "residual_relative_tolerance": 1e-6, "residual_absolute_tolerance": 1e-11, "max_iteration": args.iterations,
            "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"}, "rotation_dofs": False, "volumetric_strain_dofs": False},
        "processes": {
            "constraints_process_list": [fix("bottom", [True] * 3), fix("top", [True] * 3, down), *(fix(f"axis{k}", [j == k for j in range(3)], (0.0, 0.0, 0.0)) for k in range(upright))],
            "contact_process_list": [{"python_module": "alm_contact_process", "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication", "process_name": "ALMContactProcess",
                                      "Parameters": {"model_part_name": "Structure", "assume_master_slave": {"0": ["slave"]}, "contact_model_part": {"0": ["contact"]},
                                                     "contact_type": "Frictionless"}}]}}
    model, iterations = kratos.Model(), []

    class Analysis(StructuralMechanicsAnalysis):
        def FinalizeSolutionStep(self):
            super().FinalizeSolutionStep()
            iterations.append(model["Structure"].ProcessInfo[kratos.NL_ITERATION_NUMBER])

    Analysis(model, kratos.Parameters(json.dumps(settings))).Run()
variable = (kratos.REACTION_X, kratos.REACTION_Y, kratos.REACTION_Z)[upright]
top, bottom = (sum(node.GetSolutionStepValue(variable) for node in model[f"Structure.{name}"].Nodes) for name in ("top", "bottom"))
if not abs(top + bottom) < 1e-6 * abs(top):
    raise SystemExit(f"no equilibrium: top {top}, bottom {bottom}")
report(abs(top) * scene.fold, sum(map(len, used.values())) * dim, sum(iterations), args.steps)
