"""What to cite for a run: the programs that made it, the method, the paper that its scene is of."""

from importlib.metadata import version

from lammps_inputs import all_scenes
from run_files.manifest import Manifest

NARROWS = "The narrows maintainers, narrows: particles driven through narrow spaces, version {}"
LAMMPS = (
    "A. P. Thompson et al., LAMMPS - a flexible simulation tool for particle-based materials "
    "modeling at the atomic, meso, and continuum scales, Comput. Phys. Commun. 271, 108171 (2022)"
)
MPC = (
    "A. Malevanets and R. Kapral, Mesoscopic model for solvent dynamics, "
    "J. Chem. Phys. 110, 8605 (1999)"
)
MDANALYSIS = (
    "N. Michaud-Agrawal, E. J. Denning, T. B. Woolf and O. Beckstein, MDAnalysis: a toolkit for "
    "the analysis of molecular dynamics simulations, J. Comput. Chem. 32, 2319 (2011)"
)
PAPERS = {
    "tabatabaei-2009": "F. Tabatabaei, Hydrodynamics of colloids in a narrow channel: an "
    "analytical and simulation study, thesis, Universität Bonn (2009)",
    "hecht-2005": "M. Hecht, J. Harting, T. Ihle and H. J. Herrmann, Simulation of claylike "
    "colloids, Phys. Rev. E 72, 011408 (2005)",
    "delhommelle-2005": 'J. Delhommelle, Should "lane formation" occur systematically in driven '
    "liquids and colloids?, Phys. Rev. E 71, 016705 (2005)",
    "carmer-2012": "J. Carmer, F. van Swol and T. M. Truskett, Position-dependent and pair "
    "diffusivity profiles from steady-state solutions of color reaction-counterdiffusion "
    "problems (2012)",
}


def citations(manifest: Manifest) -> list[str]:
    """What to cite for a run, one line each."""
    scene = all_scenes().get(manifest.scene)
    lines = [NARROWS.format(manifest.versions.get("narrows", version("narrows")))]
    if scene and scene.paper:
        lines.append(PAPERS[scene.paper])
    if manifest.system.solvent:
        lines.append(MPC)
    if "lammps" in manifest.versions:
        lines.append(LAMMPS)
    return [*lines, MDANALYSIS]
