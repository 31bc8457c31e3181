"""The gallery: `python docs/gallery.py` makes its pictures and writes its page, docs/gallery.md.

Every picture is made by the commands that the page shows under it, in a folder that is thrown away.
`--page` writes the page alone, with the pictures that are there.
"""

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

DOCS = Path(__file__).parent
PICTURES = DOCS / "figures" / "gallery"
PAGE = DOCS / "gallery.md"
WIDTHS = (900, 720, 560, 420)  # pixels; the first that is small enough
COLOURS = 128
MOST_BYTES = 150_000

THESIS, CLAY, LANES, PORES = "tabatabaei-2009", "hecht-2005", "delhommelle-2005", "carmer-2012"


@dataclass(frozen=True)
class Entry:
    """A picture.

    Attributes:
        name: of its file here.
        title: its heading.
        paper: of which it shows a system, as `narrows reproduce` names it.
        shows: what is to be seen.
        commands: lines of a shell, after those of the entries before it.
        picture: the file that they leave.
    """

    name: str
    title: str
    paper: str
    shows: str
    commands: Sequence[str]
    picture: str


ENTRIES: tuple[Entry, ...] = (
    Entry(
        "chain",
        "A chain settles in a slit",
        THESIS,
        "31 colloids, pulled to the right, 600 time units after their release as a straight "
        "chain: at the head, dark, they zigzag; the tail spreads.",
        (
            "narrows run channel --set length=300 --set colloids=31 --set spacing=5 "
            "--set equilibration=0 --set duration=600 --set sampling_interval=3 --out runs/chain",
            "narrows picture runs/chain --out chain.png",
        ),
        "chain.png",
    ),
    Entry(
        "zigzag",
        "The zigzag grows at the head",
        THESIS,
        "The same run. Below: how far each colloid stands off its neighbours' mean height, "
        "against time; above: the mean over the chain with alternating signs.",
        ("narrows analyze runs/chain",),
        "runs/chain/zigzag.png",
    ),
    Entry(
        "two_flows",
        "The flow about a settling colloid, with and without hydrodynamics",
        THESIS,
        "Stream lines over the speed of the fluid, in the laboratory, about a colloid that is "
        "pulled to the right. With hydrodynamics it takes the fluid along; without, all particles "
        "interchange velocities at each collision, which leaves noise.",
        (
            "narrows run channel --set colloids=1 --set gravity=0.3 --set width=14 --set length=56 "
            "--set duration=3000 --set flow_interval=100 --set flow_bin=1 --set flow_around=1 "
            "--out runs/with",
            "narrows run channel --set colloids=1 --set gravity=0.3 --set width=14 --set length=56 "
            "--set duration=3000 --set flow_interval=100 --set flow_bin=1 --set flow_around=1 "
            "--set hydrodynamics=shuffle --out runs/without",
            "python docs/examples/python/two_flows.py runs/with runs/without two_flows.png",
        ),
        "two_flows.png",
    ),
    Entry(
        "poiseuille",
        "Poiseuille flow",
        THESIS,
        "Velocity of a fluid that gravity pulls through a slit 25 cells wide, with standard "
        "errors, and the parabola.",
        (
            "narrows run poiseuille --set gravity=0.002 --out runs/slit",
            "narrows analyze runs/slit",
        ),
        "runs/slit/profile.png",
    ),
    Entry(
        "shock",
        "A shock in a lattice gas",
        THESIS,
        "Charge on 10 000 sites against time: a one-sided shock walks to the left. Black: its "
        "place, fitted to 20 such walks.",
        (
            "narrows lattice simulate docs/examples/lattice/one_sided.toml --sites 10000 "
            "--replicas 20 --time 2000 --samples 81 --from 5500 --seed 1 --figures shock",
        ),
        "shock/space_time.png",
    ),
    Entry(
        "potentials",
        "What clay particles feel of each other",
        CLAY,
        "DLVO potentials of alumina spheres in water by surface potential and screening, with "
        "the paper's numbers.",
        ("narrows reproduce hecht-2005 1 --quick --out runs/clay",),
        "runs/clay/figure-1.png",
    ),
    Entry(
        "suspension",
        "A suspension that clusters",
        CLAY,
        "165 charged spheres in a fluid of 200 000 particles, clusters by colour, the others grey.",
        (
            "narrows run claylike --set volume_fraction=0.05 --set duration=60 "
            "--set equilibration=30 --out runs/suspension",
            "narrows analyze runs/suspension",
        ),
        "runs/suspension/suspension.png",
    ),
    Entry(
        "neighbours",
        "Its radial distribution function",
        CLAY,
        "Of the same run: neighbours stand in the primary minimum, at contact.",
        (),
        "runs/suspension/radial_distribution.png",
    ),
    Entry(
        "sheared",
        "A suspension between moving walls",
        CLAY,
        "Velocity of the colloids between two walls across z, the upper moving to the right, the "
        "lower to the left.",
        (
            "narrows run claylike --set boundaries=bottom --set shear_rate=0.02 --set duration=120 "
            "--set equilibration=30 --out runs/sheared",
            "narrows analyze runs/sheared",
        ),
        "runs/sheared/shear_flow.png",
    ),
    Entry(
        "lanes",
        "Two colours driven against each other",
        LANES,
        "896 soft disks, orange pulled to the right, blue to the left, under a kinetic thermostat: "
        "two lanes.",
        (
            "narrows run lanes --set field=5 --set duration=250 --set equilibration=250 "
            "--out runs/lanes",
            "narrows picture runs/lanes --out lanes.png",
        ),
        "lanes.png",
    ),
    Entry(
        "lane_flow",
        "Who is where in the lanes",
        LANES,
        "Density and velocity of each colour across the field.",
        ("narrows analyze runs/lanes",),
        "runs/lanes/colour_flow.png",
    ),
    Entry(
        "pore",
        "Diffusivity across a pore",
        PORES,
        "D(z) of hard spheres between walls, from colours that react there with probability 0.1 "
        "or 1, with 95 % errors, and their density.",
        (
            "narrows run pore --set packing_fraction=0.2 --set reaction_probabilities=[0.1,1] "
            "--set duration=2000 --out runs/pore",
            "narrows analyze runs/pore",
        ),
        "runs/pore/diffusivity.png",
    ),
    Entry(
        "sweep",
        "A sweep",
        THESIS,
        "Numbers of the analysis against gravity, with errors: three points of four runs each.",
        (
            "narrows sweep channel --over gravity=0.05,0.1,0.2 --repeats 4 --set duration=200 "
            "--set equilibration=50 --out runs/speed",
            "narrows report runs/speed",
        ),
        "runs/speed/sweep.png",
    ),
)


def page() -> str:
    """The text of docs/gallery.md."""
    parts = [
        "# Gallery",
        "Pictures, the paper whose system they show, their file, and the commands that made them, "
        "in a clone, one after the other: a picture may be of a run above it. `python "
        "docs/gallery.py` makes them all again, and this page, in about five minutes of one core.",
    ]
    for entry in ENTRIES:
        parts += [
            f"## {entry.title}",
            f"![{entry.title}](figures/gallery/{entry.name}.png)",
            f"{entry.shows} [{entry.paper}](reproduce.md#{entry.paper}), `{entry.picture}`.",
        ]
        if entry.commands:
            parts.append("```sh\n" + "\n".join(entry.commands) + "\n```")
    return "\n\n".join(parts) + "\n"


def make(folder: Path) -> Iterator[tuple[Entry, Path]]:
    """Each entry with its picture, made in that folder.

    Raises:
        SystemExit: for a command that fails, with what it said.
    """
    (folder / "docs").symlink_to(DOCS.resolve())
    here = f"{Path(sys.executable).parent}:{os.environ.get('PATH', '')}"
    for entry in ENTRIES:
        for line in entry.commands:
            done = subprocess.run(
                line,
                shell=True,
                cwd=folder,
                env=os.environ | {"PATH": here},
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                check=False,
            )
            if done.returncode:
                sys.exit(f"{entry.name}: {line}\n{done.stdout}")
        yield entry, folder / entry.picture


def keep(picture: Path, target: Path) -> int:
    """Write a picture into the repository, of few colours, as wide as it may be; its bytes."""
    from PIL import Image

    image = Image.open(picture).convert("RGB")
    target.parent.mkdir(parents=True, exist_ok=True)
    for width in WIDTHS:
        size = (width, round(image.height * width / image.width))
        shown = image.resize(size, Image.Resampling.LANCZOS) if width < image.width else image
        shown.quantize(COLOURS, dither=Image.Dither.NONE).save(target, optimize=True)
        if (size_in_bytes := target.stat().st_size) <= MOST_BYTES:
            return size_in_bytes
    sys.exit(f"{target}: {size_in_bytes} bytes; at most {MOST_BYTES}")


def main() -> None:
    """Make all pictures, unless the page alone is asked for; write the page."""
    if "--page" not in sys.argv[1:]:
        before = 0.0
        with tempfile.TemporaryDirectory() as folder:
            for entry, picture in make(Path(folder)):
                size = keep(picture, PICTURES / f"{entry.name}.png")
                spent = resource.getrusage(resource.RUSAGE_CHILDREN)
                seconds = spent.ru_utime + spent.ru_stime
                print(f"{entry.name}: {seconds - before:.0f} s, {size} bytes", flush=True)
                before = seconds
        print(f"all: {before / 60:.1f} minutes of processor time")
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
