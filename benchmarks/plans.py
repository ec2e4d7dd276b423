"""Makes the plans of one sample with every profile, and the pictures of docs/fabrication.md from them.

Run it: python -m benchmarks.plans
The files go to out/plans, the pictures to docs/pictures/plans. Needs pillow (requirements/dev.txt) and pdftoppm
(Debian's poppler-utils), which draws the PDF files: the pictures are what another program sees.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

from PIL import Image

import solver

ROOT = Path(__file__).resolve().parents[1]
SAMPLE = ROOT / "sample_patterns" / "fan.svg"
FILES, PICTURES = ROOT / "out" / "plans", ROOT / "docs" / "pictures" / "plans"
#: Dots to the inch, and the space and colour between pages.
DPI, SPACE, GREY = 90, 12, (200, 200, 200)
#: Board of which thickness is grooved, mm; how deep the sample folds, degrees.
THICKNESS, ANGLE = 1.5, 60.0
#: Picture -> how its plan is made.
PLANS = {
    **{
        name: solver.PlanDescription(name)
        for name in ("origami", "laser-lightburn", "laser-glowforge", "plotter", "two-sided", "packaging")
    },
    "rulings": solver.PlanDescription("origami", rulings=True),
    "board": solver.PlanDescription("board", thickness_mm=THICKNESS),
    "print": solver.PlanDescription("print", tile="A5"),
}


def main() -> None:
    if shutil.which("pdftoppm") is None:
        raise SystemExit("the pictures need pdftoppm (Debian's package poppler-utils)")
    result = solver.fold(solver.read_pattern(SAMPLE), solver.FoldDescription(angle=ANGLE))
    print(result.summary())
    results = FILES / "folded"
    solver.write_results(result, results, with_rulings=True)
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name, description in PLANS.items():
        made = solver.plan(results, description)
        for suffix in (".svg", ".dxf", ".pdf"):
            for path in solver.write_plan(made, FILES / f"{name}{suffix}"):
                print(path.relative_to(ROOT))
        drawn(FILES / f"{name}.pdf").save(PICTURES / f"{name}.png", optimize=True)


def drawn(path: Path) -> Image.Image:
    """The pages of a PDF side by side."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["pdftoppm", "-r", str(DPI), "-png", str(path), f"{folder}/page"], check=True)
        pages = [Image.open(page).convert("RGB") for page in sorted(Path(folder).glob("*.png"))]
    width = sum(page.width for page in pages) + SPACE * (len(pages) + 1)
    sheet = Image.new("RGB", (width, max(page.height for page in pages) + 2 * SPACE), GREY)
    at = SPACE
    for page in pages:
        sheet.paste(page, (at, SPACE))
        at += page.width + SPACE
    return sheet.quantize(64)


if __name__ == "__main__":
    main()
