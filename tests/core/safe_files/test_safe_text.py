"""Text, JSON and TOML: bounded in size and depth, every number finite, every text writable again."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import MAX_DEPTH, parse_json, read_json, read_text, read_toml


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ('{"a": [1, 2.5, "é", null, true]}', {"a": [1, 2.5, "é", None, True]}),
        ("1e308", 1e308),
        ("9" * 64, int("9" * 64)),
        ("[" * MAX_DEPTH + "]" * MAX_DEPTH, None),
        ("\ufeff3", 3),
    ],
)
def test_json_is_read(text: str, value: object):
    found = parse_json(text.encode(), "a.json")
    assert value is None or found == value


@pytest.mark.parametrize(
    "text",
    ["", "{", "NaN", "[Infinity]", "-Infinity", "1e309", "9" * 65, "[" * 52 + "]" * 52, "[" * 100_000, '{"a":' * 60,
     '"\\ud800"', '{"\\ud800": 1}', "9" * 5000, "1" + "0" * 400 + ".0"],
)  # fmt: skip
def test_json_that_could_not_be_used_or_written_again_is_refused(text: str):
    with pytest.raises(InputError, match=r"a\.json .*JSON"):
        parse_json(text, "a.json")


def test_files_have_a_largest_size_and_an_encoding(tmp_path: Path):
    file = tmp_path / "a.json"
    file.write_bytes(b"[1]" + b" " * 100)
    assert read_json(file) == [1]
    with pytest.raises(InputError, match=r"a\.json .*MB"):
        read_json(file, max_bytes=50)
    file.write_bytes(b"caf\xe9")
    with pytest.raises(InputError, match=r"UTF-8.*byte 3"):
        read_text(file)
    assert read_text(file, errors="replace") == "caf\ufffd"
    file.write_bytes(b"\xef\xbb\xbfplain")
    assert read_text(file) == "plain"


def test_toml_has_the_same_limits(tmp_path: Path):
    file = tmp_path / "a.toml"
    file.write_text('frames = 20\n[a]\nb = ["c", 1.5]\n')
    assert read_toml(file) == {"frames": 20, "a": {"b": ["c", 1.5]}}
    for text in ("a = inf", "a = nan", "a = 1e400", "a = " + "[" * 5000, "a = 1\na = 2", "a = " + "9" * 300, "a"):
        file.write_text(text)
        with pytest.raises(InputError, match=r"a\.toml.*TOML"):
            read_toml(file)
