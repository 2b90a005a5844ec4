"""The typed stubs say what the module has, and what a scenario takes."""

import re
import subprocess
import sys
from importlib.resources import files

import keys_of_scenarios
import mppflight
import nbformat
import pytest


def mypy(*arguments):
    done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def test_stubs_and_module_agree():
    assert (files("mppflight") / "py.typed").is_file()
    code, told = mypy("mypy.stubtest", "mppflight._native")
    assert code == 0, told


def test_the_python_half_is_typed():
    code, told = mypy("mypy", "--strict", "-p", "mppflight")
    assert code == 0, told


def test_the_types_of_keys_are_those_that_the_package_takes():
    """`keys_of_scenarios.py` writes the file anew."""
    assert (files("mppflight") / "keys.py").read_text() == keys_of_scenarios.text()


WRONG = """
import mppflight
mppflight.fly(sede=7)  # type: ignore[call-overload]
mppflight.fly(seed="7")  # type: ignore[call-overload]
mppflight.fly(obstacles=7, density=0.1)  # type: ignore[call-overload]
mppflight.fly(preset="space", obstacles=7)  # type: ignore[call-overload]
mppflight.fly(lidar={"bems": 7})  # type: ignore[call-overload]
mppflight.fly(faults={"gusts": {"strength": 1.0}})  # type: ignore[call-overload]
mppflight.World(sede=7)  # type: ignore[call-arg]
mppflight.Planner(scene="flytrip")  # type: ignore[arg-type]
mppflight.Core(lidar=mppflight.Field.generate())  # type: ignore[arg-type]
mppflight.Lidar(bems=7)  # type: ignore[call-arg]
mppflight.campaign(trials=1, obstacle=[20])  # type: ignore[call-arg]
mppflight.campaign(trials=1, preset=["flihgt"])  # type: ignore[list-item]
mppflight.fly(seed=7, preset="flight", aircraft=mppflight.Aircraft("zagi"), generator={"name": "forest", "gap": 3.0})
mppflight.fly(preset="space", density=0.1, wind=[1.0, 0.0, 0.0])
mppflight.campaign(trials=1, preset=["paper", "flight"], obstacles=20, faults={"lidar": {"dropouts": 0.1}})
"""


def test_the_examples_are_typed_and_wrong_keys_are_errors(root, tmp_path):
    """Notebook and page, as a reader puts them together. An ignored line without an error is an error itself."""
    notebooks = {name: nbformat.read(root / f"bindings/python/examples/{name}.ipynb", as_version=4) for name in ("figure8", "tour")}
    cells = {f"{name}.py": [cell.source for cell in it.cells if cell.cell_type == "code"] for name, it in notebooks.items()}
    page = re.findall(r"^```python\n(.*?)^```", (root / "docs/python.md").read_text(), re.DOTALL | re.MULTILINE)
    assert all(cells.values()) and len(page) > 4
    sources = {**cells, "page.py": page, "wrong.py": [WRONG]}
    for name, blocks in sources.items():
        (tmp_path / name).write_text("\n".join(blocks))
    foreign = "--untyped-calls-exclude=distributed"
    own = [str(root / f"bindings/python/examples/{name}.py") for name in ("agent", "rerun_forest")]
    code, told = mypy("mypy", "--strict", foreign, *own, *(str(tmp_path / name) for name in sources))
    assert code == 0, told


@pytest.mark.parametrize("use", [mppflight.fly, mppflight.World, mppflight.Planner, mppflight.Core])
def test_a_wrong_key_has_a_suggestion(use):
    with pytest.raises(mppflight.InputError, match=r"there is no key `sede` \(did you mean `seed`\?\)"):
        use(sede=7)
    with pytest.raises(mppflight.InputError, match=r"there is no key `obstacle` \(did you mean `obstacles`\?\)"):
        mppflight.campaign(trials=1, obstacle=[20])
