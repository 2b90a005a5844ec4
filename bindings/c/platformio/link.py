"""Links the archive for the board's processor: that with double floats for a Cortex-M7, else that with single ones."""

from os.path import realpath

Import("env")  # noqa: F821: SCons gives both names.
archive = "cortex-m7" if env.BoardConfig().get("build.cpu", "") == "cortex-m7" else "cortex-m4"  # noqa: F821
DefaultEnvironment().Append(LIBPATH=[realpath(f"lib/{archive}")], LIBS=["mpp"])  # noqa: F821
