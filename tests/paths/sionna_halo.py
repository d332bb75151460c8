"""Body and rough walls of a concrete box by Sionna RT, for test_second_order: python sionna_halo.py body.npz."""

import sys
from pathlib import Path

import numpy as np
import sionna.rt as rt

FREQUENCY_HZ = 79.06329505986696e9
SIDES = (  # centre, normal, axis, half sizes
    ((0, 2.5, -1.1), (0, 0, 1), (1, 0, 0), (2, 3)),
    ((0, 5, 0.2), (0, -1, 0), (1, 0, 0), (2, 1.3)),
    ((-2, 2.5, 0.2), (1, 0, 0), (0, -1, 0), (2.5, 1.3)),
    ((2, 2.5, 0.2), (-1, 0, 0), (0, 1, 0), (2.5, 1.3)),
    ((0, 2.5, 1.5), (0, 0, -1), (-1, 0, 0), (2, 2.5)),
)


def material(name: str, kind: str, scattering: float, thickness_m: float) -> str:
    return (
        f'<bsdf type="itu-radio-material" id="{name}"><string name="type" value="{kind}"/>'
        f'<float name="thickness" value="{thickness_m}"/>'
        f'<float name="scattering_coefficient" value="{scattering}"/></bsdf>'
    )


def side(index: int) -> str:
    centre, normal, axis, half = (np.array(part, float) for part in SIDES[index])
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1] = axis * half[0], np.cross(normal, axis) * half[1]
    matrix[:3, 2], matrix[:3, 3] = normal, centre
    numbers = " ".join(f"{value:.9g}" for value in matrix.ravel())
    return (
        f'<shape type="rectangle" id="side{index}"><transform name="to_world"><matrix value="{numbers}"/></transform>'
        '<ref name="bsdf" id="wall"/></shape>'
    )


def write_ply(path: str, vertices: np.ndarray, faces: np.ndarray) -> None:
    head = (
        f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
    )
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = [" ".join(f"{value:f}" for value in row) for row in vertices]
    rows += [f"3 {a} {b} {c}" for a, b, c in faces]
    Path(path).write_text(head + "\n".join(rows) + "\n", encoding="ascii")


def main() -> None:
    with np.load(sys.argv[1]) as stored:
        ply = sys.argv[1].replace(".npz", ".ply")
        write_ply(ply, stored["vertices"], stored["faces"])
    text = '<scene version="2.1.0">' + material("wall", "concrete", 0.35, 0.2) + material("skin", "metal", 0.9, 0.01)
    text += "".join(side(index) for index in range(len(SIDES)))
    text += f'<shape type="ply" id="body"><string name="filename" value="{ply}"/>'
    text += '<ref name="bsdf" id="skin"/></shape></scene>'
    scene = rt.load_scene_from_string(text)
    scene.frequency = FREQUENCY_HZ
    scene.tx_array = scene.rx_array = rt.PlanarArray(
        num_rows=1, num_cols=1, vertical_spacing=0.5, horizontal_spacing=0.5, pattern="tr38901", polarization="V"
    )
    scene.add(rt.Transmitter("tx", position=[0, 0, 0], look_at=[0, 3, 0]))
    scene.add(rt.Receiver("rx", position=[1e-3, 0, 0], look_at=[0, 3, 0]))
    paths = rt.PathSolver()(
        scene, max_depth=2, los=False, specular_reflection=False, diffuse_reflection=True, refraction=False,
        samples_per_src=1_000_000, seed=1, max_num_paths_per_src=3_000_000,
    )  # fmt: skip
    power = np.abs(np.array(paths.a[0]) + 1j * np.array(paths.a[1])).ravel() ** 2
    range_m = 299792458.0 * np.array(paths.tau).ravel() / 2
    objects = np.array(paths.objects)
    body = next(one.object_id for one in scene.objects.values() if one.name == "body")
    over_body = (objects.reshape(objects.shape[0], -1) == body).any(axis=0)
    direct = power[over_body & (range_m > 1.6) & (range_m < 2.4)].sum()
    edges_m = np.arange(2.4, 4.81, 0.4)
    found, _ = np.histogram(range_m[over_body], edges_m, weights=power[over_body])
    sys.stdout.write(" ".join(f"{value:.2f}" for value in 10 * np.log10(found / direct)))


if __name__ == "__main__":
    main()
