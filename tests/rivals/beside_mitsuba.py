#!/usr/bin/env python3
"""tests/rivals/beside_mitsuba.py: this program beside Mitsuba 3 on the scenes of tests/golden that both can render.

    pip install mitsuba==3.9.1 pyyaml
    cargo build --release
    tests/rivals/beside_mitsuba.py [--scene NAME]... [--samples N] [--reference N] [--rounds N] [--threads N] [--variant NAME]
                            [--size N] [--program PATH]

Both render the same scene with the same samples a pixel and the same number of threads, in turn; the time is that of
rendering alone (Mitsuba's kernels are compiled before), the median of all rounds. Errors are relMSE = mean
(x - r)^2 / (r^2 + 0.01) against a picture r of Mitsuba's with --reference samples of another seed, whose own error is in
all figures: with 4096 it is 1/64 of that of 64 samples. Efficiency is 1 / (relMSE x seconds).

The variants `llvm_*` need LLVM's shared library (Debian: libllvm15, or what DRJIT_LIBLLVM_PATH names); `scalar_rgb` does not.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

import numpy as np
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The longest paths, in segments, as the references have them.
BOUNCES = {"A": 8, "B": 16, "D": 16}


def rgb(color):
    return {"type": "rgb", "value": [float(c) for c in color]}


def placed(mi, shape, basis):
    """Where a shape of side 2 about the origin goes, after `basis`."""
    to_world = mi.ScalarTransform4f().translate(shape["Position"])
    # About x, then y, then z.
    axes = zip(([0, 0, 1], [0, 1, 0], [1, 0, 0]), reversed(shape.get("Rotation", [0, 0, 0])))
    for axis, degrees in axes:
        to_world = to_world @ mi.ScalarTransform4f().rotate(axis, degrees)
    return to_world @ basis


def bsdf(material):
    kind, color = material["Type"], material.get("Color", [1, 1, 1])
    if kind == "Diffuse":
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(color)}}
    if kind == "Reflective" and material.get("Specularity", 1) == 1:
        return {"type": "conductor", "material": "none", "specular_reflectance": rgb(color)}
    if kind == "Refractive" and color == [1, 1, 1]:
        return {"type": "dielectric", "int_ior": 1 / material["RefractionRatio"], "ext_ior": 1.0}
    raise SystemExit(f"this script does not translate the material {material}")


def translated(mi, shape, middle):
    """An object of a scene in Mitsuba's words. Lights shine towards the middle: Mitsuba's have one side, ours two."""
    kind, material = shape["Type"], shape["Material"]
    emission = np.array(material.get("EmissionColor", [1, 1, 1]), float) * material.get("EmissionStrength", 0)
    if kind == "Ball":
        made = {"type": "sphere", "center": shape["Position"], "radius": shape["Radius"]}
    elif kind == "Box":
        half = [shape["Depth"] / 2, shape["Width"] / 2, shape["Height"] / 2]
        made = {"type": "cube", "to_world": placed(mi, shape, mi.ScalarTransform4f().scale(half))}
    elif kind == "Rectangle":
        y, z = shape["Width"] / 2, shape["Height"] / 2
        front = [[0, 0, -1, 0], [-y, 0, 0, 0], [0, z, 0, 0], [0, 0, 0, 1]]
        back = [[0, 0, 1, 0], [y, 0, 0, 0], [0, z, 0, 0], [0, 0, 0, 1]]
        to_world = placed(mi, shape, mi.ScalarTransform4f(front))
        normal = (np.array(to_world.matrix)[:3, :3] @ [0, 0, 1])
        if emission.any() and normal @ (middle - np.array(shape["Position"])) < 0:
            to_world = placed(mi, shape, mi.ScalarTransform4f(back))
        made = {"type": "rectangle", "to_world": to_world}
    else:
        raise SystemExit(f"this script does not translate a {kind}")
    if emission.any():
        made["emitter"] = {"type": "area", "radiance": rgb(emission)}
    return made | {"bsdf": bsdf(material)}


def mitsuba_scene(mi, path, bounces, size):
    text = yaml.safe_load(path.read_text())
    camera, shapes = text["Camera"], [item["Object"] for item in text["Objects"]]
    middle = np.mean([shape["Position"] for shape in shapes], axis=0)
    view = mi.ScalarTransform4f().look_at(camera["Position"], camera["LookingAt"], [0, 0, 1])
    film = {"type": "hdrfilm", "width": size, "height": size, "pixel_format": "rgb", "rfilter": {"type": "box"}}
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": bounces},
        "sensor": {
            "type": "perspective", "fov": 180 * camera["Fov"], "fov_axis": "x", "near_clip": 1e-3, "far_clip": 1e4,
            "to_world": view, "film": film, "sampler": {"type": "multijitter"},
        },
    }
    sky = text["Environment"]
    colors = [sky[name] for name in ("SkyColor", "HorizonColor", "GroundColor")]
    if any(color != colors[0] for color in colors):
        raise SystemExit("this script translates skies of one colour only")
    if any(colors[0]):
        scene["sky"] = {"type": "constant", "radiance": rgb(colors[0])}
    return mi.load_dict(scene | {f"object{i}": translated(mi, shape, middle) for i, shape in enumerate(shapes)})


def mitsuba_picture(mi, scene, samples, seed):
    start = time.perf_counter()
    picture = np.array(mi.render(scene, spp=samples, seed=seed))
    return picture, time.perf_counter() - start


def own_picture(mi, program, path, bounces, size, samples, seed, threads):
    with tempfile.TemporaryDirectory() as folder:
        image = f"{folder}/picture.exr"
        command = [program, path, size, size, samples, bounces, image, "--seed", seed, "--threads", threads, "--json", "--quiet"]
        lines = subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout
        seconds = json.loads(lines.splitlines()[-1])["render_seconds"]
        bitmap = mi.Bitmap(image).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
        return np.array(bitmap), seconds


def rel_mse(picture, reference):
    return float(np.mean((picture - reference) ** 2 / (reference**2 + 0.01)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", action="append", choices=BOUNCES, help="A (Cornell box), B (glass balls), D (caustics)")
    for name, value in [("samples", 64), ("reference", 4096), ("rounds", 3), ("threads", 2), ("size", 512)]:
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "target/release/pathtracer")
    given = parser.parse_args()

    import drjit
    import mitsuba as mi

    mi.set_variant(given.variant)
    drjit.set_thread_count(given.threads)
    print(f"Mitsuba {mi.__version__} {given.variant}, {given.size} x {given.size} pixels, {given.samples} samples, {given.threads} threads")
    for name in given.scene or BOUNCES:
        path, bounces = ROOT / f"tests/golden/{name}.yaml", BOUNCES[name]
        scene = mitsuba_scene(mi, path, bounces, given.size)
        # In pieces, which need less memory; each has a seed of its own.
        pieces = max(1, given.reference // 256)
        reference = np.mean([mitsuba_picture(mi, scene, given.reference // pieces, 1000 + i)[0] for i in range(pieces)], axis=0)
        mitsuba_picture(mi, scene, given.samples, 0)
        theirs, ours = [], []
        for seed in range(given.rounds):
            picture, seconds = mitsuba_picture(mi, scene, given.samples, seed)
            theirs.append((seconds, rel_mse(picture, reference)))
            picture, seconds = own_picture(mi, given.program, path, bounces, given.size, given.samples, seed, given.threads)
            ours.append((seconds, rel_mse(picture, reference)))
        bias = float(np.mean(picture) / np.mean(reference) - 1)
        (their_time, their_error), (our_time, our_error) = ([statistics.median(row) for row in zip(*rows)] for rows in (theirs, ours))
        print(f"{name}: Mitsuba {their_time:.2f} s, relMSE {their_error:.5f}; pathtracer {our_time:.2f} s, relMSE {our_error:.5f}; "
              f"efficiency, ours by theirs {their_error * their_time / (our_error * our_time):.2f}; means differ by {100 * bias:+.2f} %")


if __name__ == "__main__":
    main()
