"""Our private messages, for pymavlink.

pymavlink's own generator makes them from `mpp.xml`, together with the complete common dialect that
pymavlink ships. This takes a few seconds, so the module is kept in the user's cache.
"""

import contextlib
import hashlib
import importlib.util
import io
import os
import shutil
import sys
import tempfile
from pathlib import Path

# This must happen before the import of pymavlink, which would start with MAVLink 1 and without signatures.
os.environ.setdefault("MAVLINK20", "1")

import pymavlink
from pymavlink import mavutil

XML = Path(__file__).with_name("mpp.xml")
NAME = "mpp"


def load():
    """Makes pymavlink speak the dialect. Returns the dialect's module."""
    if mavutil.current_dialect != NAME:
        path = generated()
        full_name = f"pymavlink.dialects.v20.{NAME}"
        spec = importlib.util.spec_from_file_location(full_name, path)
        module = importlib.util.module_from_spec(spec)
        sys.modules[full_name] = module
        spec.loader.exec_module(module)
        mavutil.mavlink = module
        mavutil.current_dialect = NAME
    return mavutil.mavlink


def generated():
    """The file of the generated module. It is made if this pymavlink has not made it yet."""
    version = f"{pymavlink.__version__}:{sys.version_info[:2]}".encode()
    key = hashlib.sha256(XML.read_bytes() + version).hexdigest()[:16]
    path = cache() / f"mpp_dialect_{key}.py"
    if not path.exists():
        generate(path)
    return path


def cache():
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "mpp-ground"


def generate(path):
    from pymavlink.generator import mavgen, mavparse

    definitions = Path(pymavlink.__file__).parent / "dialects" / "v20"
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        for name in ("minimal.xml", "standard.xml", "common.xml"):
            shutil.copy(definitions / name, scratch)
        shutil.copy(XML, scratch / "mpp.xml")
        options = mavgen.Opts(
            str(scratch / "mpp_dialect.py"),
            wire_protocol=mavparse.PROTOCOL_2_0,
            language="Python3",
            validate=False,
        )
        with contextlib.redirect_stdout(io.StringIO()):
            mavgen.mavgen(options, [str(scratch / "mpp.xml")])
        path.parent.mkdir(parents=True, exist_ok=True)
        # Two stations may start at once, so the complete file appears in one step.
        temporary = path.with_suffix(f".{os.getpid()}")
        shutil.copy(scratch / "mpp_dialect.py", temporary)
        temporary.replace(path)
