"""The client, and docs/link.md, against the bytes and names that the Rust side holds, and a flight."""

import re
import subprocess
from pathlib import Path

import client
import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/link.md").read_text()
FROZEN = "".join(path.read_text() for path in sorted((ROOT / "hil-protocol/tests/frozen_bytes").glob("*.rs")))
# Frames of the present version. (The first bytes of a frame are a COBS code, "MP" and the version.)
FRAMES = [line for line in re.findall(r'"((?:[0-9a-f]{2})+00)"', FROZEN) if line[2:8] == "4d5002"]


@pytest.fixture(scope="module")
def core():
    """The address of a core."""
    binary = ROOT / "target/release/sil-harness"
    process = subprocess.Popen([binary, "core", "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
    yield process.stdout.readline().split("tcp:")[-1].strip()
    process.kill()
    process.communicate()


def variants(enum):
    """The variants of an enum of the Rust side, in their order."""
    source = "".join(path.read_text() for path in sorted((ROOT / "hil-protocol/src").rglob("*.rs")))
    body = re.search(rf"pub enum {enum} {{\n(.*?)\n}}\n", source, re.DOTALL).group(1)
    return re.findall(r"^    ([A-Z]\w+)", body, re.MULTILINE)


def test_the_page_shows_frames_that_are_frozen():
    shown = re.findall(r"^[a-z0-9 ]+  ((?:[0-9a-f]{2}){8,})$", PAGE, re.MULTILINE)
    assert len(shown) == 6
    assert all(frame in FRAMES for frame in shown)
    piece_by_piece = re.search(r"^wire +((?:[0-9a-f]{2} +)+00)$", PAGE, re.MULTILINE).group(1)
    assert piece_by_piece.replace(" ", "") == shown[0]


@pytest.mark.parametrize("enum", ["ConfigureVerdict", "ParameterVerdict", "DecodeError"])
def test_the_page_lists_every_variant_in_its_order(enum):
    listed = re.search(rf"^`{enum}`: (.*?)\.\s", PAGE, re.DOTALL | re.MULTILINE).group(1)
    assert re.findall(r"\b[A-Z]\w+", re.sub(r"\(.*?\)", "", listed, flags=re.DOTALL)) == variants(enum)


def test_the_page_lists_every_cause_of_a_rejection():
    listed = re.findall(r"^\|(\d+)\|`(\w+)`\|", PAGE, re.MULTILINE)
    assert listed == [(str(place), name) for place, name in enumerate(variants("RejectionCause"))]


def test_the_client_reads_and_writes_the_frozen_bytes():
    names = {number: name for name, number in client.IDS.items()}
    again = 0
    for line in FRAMES:
        number, payload = client.unframe(bytes.fromhex(line)[:-1])
        if number not in names:
            continue
        value, end = client.read(names[number], payload)
        # The client reads the number of a verdict, and no fields of it.
        if end == len(payload):
            assert client.frame(names[number], value).hex() == line
            again += 1
    assert again > 40


def test_runs_without_a_zero_are_cut_after_254_bytes():
    for length in (253, 254, 255, 508, 600):
        scan = {"tick": 1, "angle_min": 0.5, "angle_increment": 0.1, "ranges": [1.2345678] * (length // 4)}
        wire = client.frame("LidarScan", scan)
        assert wire.count(0) == 1
        assert client.read("LidarScan", client.unframe(wire[:-1])[1])[0]["ranges"] == pytest.approx(scan["ranges"])


def test_damage_is_noticed():
    wire = bytearray.fromhex(FRAMES[0])
    wire[8] ^= 2
    with pytest.raises(ValueError, match="no frame"):
        client.unframe(bytes(wire[:-1]))


def test_the_client_fits_150_lines():
    assert len(Path(client.__file__).read_text().splitlines()) <= 150


def test_a_plant_of_its_own_flies_past_its_field_twice_the_same(core):
    clearance, commands = client.fly(core, 1)
    assert clearance > 0.2
    assert client.fly(core, 1) == (clearance, commands)
    assert client.fly(core, 2)[1] != commands


def test_a_refused_configuration_is_told(core):
    with pytest.raises(ValueError, match="verdict 3 "):
        client.Core(core, client.OWN | {"seed": 1, "latency_ticks": 0})
