"""Writes `python/mppflight/keys.py` from what the installed package says of wrong keys and values:
`python bindings/python/tests/keys_of_scenarios.py >bindings/python/python/mppflight/keys.py`.
"""

import re
import textwrap

import mppflight

HEAD = '''"""The keys of a scenario as types. tests/keys_of_scenarios.py writes this file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Literal, Required, TypeAlias, TypedDict

from ._native import Aircraft, Field, Lidar

Path: TypeAlias = str | PathLike[str]
'''
# What may stand in place of a table.
BESIDES = {
    "scenario": "Path",
    "aircraft": "Aircraft | Path | Mapping[str, Any]",
    "field": "Field | Path | Mapping[str, Any]",
    "lidar": "Lidar | Path | LidarKeys",
    "generator": "GeneratorName | GeneratorKeys",
    "navigation": "NavigationSource | NavigationKeys",
    "terrain.rows": "Sequence[Sequence[float]]",
}
# Texts whose values have a name of their own, since a campaign has lists of them.
NAMED = {"preset": "Preset", "generator.name": "GeneratorName", "navigation.source": "NavigationSource"}
# The arguments of a campaign that may be lists, and its seed.
LISTS = ("preset", "seed", "obstacles", "paths", "replan_hz", "generator")


def told(path, value, preset):
    """What the package says of a value at the end of these keys."""
    for key in reversed(path):
        value = {key: value}
    try:
        mppflight.fly(**preset, **value)
    except mppflight.InputError as error:
        return str(error)
    raise AssertionError(f"{path} takes anything")


def keys(path, preset):
    return re.search(r"there is no key `\?`: give (.*)$", told(path, {"?": 0}, preset))[1].split(", ")


def literal(path, preset):
    names = re.search(r"there is no `\?`: give (.*)$", told(path, "?", preset))[1].split(", ")
    return f"Literal[{', '.join(map(repr, names))}]".replace("'", '"')


class Written:
    """The text so far, and the tables that it has."""

    def __init__(self):
        self.lines, self.tables = [], {}

    def line(self, statement):
        kept = statement.replace(": ", ":\0")
        wrapped = textwrap.wrap(kept, 118, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
        self.lines += [line.replace("\0", " ") for line in wrapped]

    def kind(self, path, preset):
        """The type of a key's value."""
        wanted = re.search(r"give (.*), not <object", told(path, object(), preset))[1]
        name = ".".join(path)
        if wanted == "a name":
            return NAMED.get(name) or literal(path, preset)
        if wanted == "a dict of its keys" and name != "field":
            return BESIDES.get(name) or self.table(path, preset)
        if wanted.startswith("a whole number"):
            return "int"
        if preset and name == "lidar":
            # In space a lidar is the name of one.
            return "str"
        known = {"a number": "float", "True or False": "bool", "a text": "str"}
        return BESIDES.get(name) or known.get(wanted) or {"a list": "Sequence[float]"}[wanted[:6]]

    def table(self, path, preset):
        """The name of the type of a table, which is written unless there is one of the same keys."""
        own = {key: self.kind([*path, key], preset) for key in keys(path, preset)}
        text = ", ".join(f'"{key}": {kind}' for key, kind in own.items())
        if text not in self.tables:
            name = "".join(part.title().replace("_", "") for part in path) + "Keys"
            self.tables[text] = name
            self.record(name, own)
        return self.tables[text]

    def record(self, name, members):
        text = ", ".join(f'"{key}": {kind}' for key, kind in members.items())
        self.line(f'{name} = TypedDict("{name}", {{{text}}}, total=False)')


def text():
    written, plane, space = Written(), {}, {"preset": "space"}
    for path, name in NAMED.items():
        written.line(f"{name}: TypeAlias = {literal(path.split('.'), plane)}")
    for table in ("lidar", "generator", "navigation"):
        written.table([table], plane)
    every = {"scenario": BESIDES["scenario"]} | {key: written.kind([key], plane) for key in keys([], plane)}
    common = {key: kind for key, kind in every.items() if key not in LISTS}
    written.lines += ["# What all cells of a campaign have in common."]
    written.record("CommonKeys", common)
    written.lines += ["# The keys of a flight in space."]
    of_space = {key: written.kind([key], space) for key in keys([], space) if key != "preset"}
    written.record("SpaceKeys", {"preset": 'Required[Literal["space"]]', **of_space})
    written.lines += ["", "", "class ScenarioKeys(CommonKeys, total=False):"]
    written.lines += ['    """The keys of a scenario: docs/scenarios/example.toml."""', ""]
    written.lines += [f"    {key}: {every[key]}" for key in LISTS]
    return HEAD + "\n".join(written.lines) + "\n"


if __name__ == "__main__":
    print(text(), end="")
