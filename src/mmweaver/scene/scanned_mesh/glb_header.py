"""What a GLB declares, held against the bytes that are there before trimesh allocates anything.

Reference: glTF 2.0 specification, sections 3.6 (buffers, accessors), 3.5 (nodes) and 4 (GLB).
"""

import struct
from collections.abc import Iterator
from typing import Any

from mmweaver.core.safe_files.safe_text import parse_json

MAX_HEADER_BYTES = 64 * 2**20
MAX_DRAWN = 5_000_000  # triangles of all nodes together
MAX_COPIES = 8  # total size of all accessors, in sizes of the file
_HEAD = struct.Struct("<4sIIII")
_JSON = 0x4E4F534A
_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}  # of a component
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


def check_glb(content: bytes) -> None:
    """Checks the counts of a GLB.

    Args:
        content: The whole file.

    Raises:
        ValueError: If an accessor has no bytes or too few, or nodes draw more triangles than are read.
        InputError: If the header is no JSON.
    """
    if len(content) < _HEAD.size:
        raise ValueError("it ends within its header")
    _, _, _, length, kind = _HEAD.unpack_from(content)
    if kind != _JSON or length > min(MAX_HEADER_BYTES, len(content) - _HEAD.size):
        raise ValueError("its header is missing or larger than the file")
    header = parse_json(content[_HEAD.size : _HEAD.size + length], "its header")
    if not isinstance(header, dict):
        raise ValueError("its header is no JSON object")
    views, accessors = list(_objects(header, "bufferViews")), list(_objects(header, "accessors"))
    total = sum(_accessor_bytes(accessor, views) for accessor in accessors)
    if total > MAX_COPIES * len(content):
        raise ValueError(f"its accessors say {total} bytes, the file has {len(content)}")
    _check_nodes(list(_objects(header, "nodes")), [_mesh_size(mesh, accessors) for mesh in _objects(header, "meshes")])


def _accessor_bytes(accessor: dict[str, Any], views: list[dict[str, Any]]) -> int:
    count, columns = _count(accessor.get("count")), _COMPONENTS[accessor["type"]]
    if "sparse" in accessor or "bufferView" not in accessor:
        raise ValueError("an accessor has no bytes of its own (meshes compressed by Draco are not read)")
    view = views[_count(accessor["bufferView"])]
    size = columns * _BYTES[accessor["componentType"]]
    stride = _count(view.get("byteStride", size))
    if stride < size:
        raise ValueError("the values of an accessor overlap")
    needed = _count(accessor.get("byteOffset", 0)) + (stride * (count - 1) + size if count else 0)
    if needed > _count(view.get("byteLength")):
        raise ValueError(f"an accessor says {needed} bytes, its view has {view['byteLength']}")
    return size * count


def _mesh_size(mesh: dict[str, Any], accessors: list[dict[str, Any]]) -> int:
    """Corners and indices of a mesh, whichever are more."""
    size = 0
    for primitive in _objects(mesh, "primitives"):
        places = accessors[_count(primitive["attributes"]["POSITION"])]["count"]
        indices = accessors[_count(primitive["indices"])]["count"] if "indices" in primitive else 0
        size += max(places, indices)
    return size


def _check_nodes(nodes: list[dict[str, Any]], sizes: list[int]) -> None:
    """Each node is the child of at most one other, and all of them draw at most MAX_DRAWN triangles."""
    children = [child for node in nodes for child in node.get("children", [])]
    if len(set(children)) < len(children):
        raise ValueError("a node has two parents")
    drawn = sum(sizes[_count(node["mesh"])] for node in nodes if "mesh" in node)
    if drawn > 3 * MAX_DRAWN:
        raise ValueError(f"its nodes draw {drawn // 3:,} triangles, more than {MAX_DRAWN:,}")


def _objects(content: dict[str, Any], name: str) -> Iterator[dict[str, Any]]:
    values = content.get(name, [])
    if not isinstance(values, list) or not all(isinstance(one, dict) for one in values):
        raise ValueError(f"its {name} are no list of objects")
    yield from values


def _count(value: Any) -> int:
    if type(value) is not int or value < 0:
        raise ValueError(f"it counts {value!r} of something")
    return value
