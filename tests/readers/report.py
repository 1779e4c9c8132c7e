"""Opens what `kerfold check --report` writes with programs that are not ours: a browser for HTML, poppler for PDF.

usage: report.py KERFOLD [FOLDER]

Checks that the page opens in a headless browser without an error and shows every picture in it, and that the PDF has as many pictures,
the same figures as the page, tags, names in other letters, and pages of A4. Exits with 1 and says what is wrong.
"""

import html
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# Put into a copy of the page: says what the browser made of it. The page itself runs nothing.
PROBE = """<script>
window.addEventListener('load', () => {
  const all = [...document.images];
  document.title = 'probe ' + all.filter(i => i.complete && i.naturalWidth > 1).length + ' of ' + all.length;
});
</script>"""


def output(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, **options)


def main():
    kerfold = Path(sys.argv[1]).resolve()
    browser = next((path for name in ["chromium", "chromium-browser", "google-chrome"] if (path := shutil.which(name))), None)
    if browser is None:
        sys.exit("report.py: no chromium")
    faults = []
    with tempfile.TemporaryDirectory() as temporary:
        base = Path(sys.argv[2] if len(sys.argv) > 2 else temporary).resolve()
        base.mkdir(parents=True, exist_ok=True)
        model = base / "bent.obj"
        output(kerfold, "solid", "cuboctahedron", "--size", "3m", "-o", model, "--quiet")
        lines = model.read_text().splitlines()
        first = next(i for i, line in enumerate(lines) if line.startswith("v "))
        lines[first] = "v " + " ".join(str(1.1 * float(x)) for x in lines[first].split()[1:])
        model.write_text("\n".join(lines) + "\n")
        page, paper = base / "report.html", base / "report.pdf"
        for path in [page, paper]:
            ran = subprocess.run([kerfold, "check", model, "--require", "valence3", "--report", path, "--quiet"], capture_output=True)
            if ran.returncode != 1:
                faults.append(f"{path.name}: exit code {ran.returncode}")
        text = page.read_text()
        pictures = text.count("<img ")
        probed = base / "probed.html"
        probed.write_text(text.replace("</head>", PROBE + "</head>"))
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=10000", "--enable-logging=stderr"]
        seen = output(browser, *options, "--dump-dom", probed.as_uri(), timeout=120)
        title = re.search(r"<title>(.*?)</title>", seen.stdout)
        if not title or title[1] != f"probe {pictures} of {pictures}" or pictures < 5:
            faults.append(f"{pictures} pictures in the page, the browser says {title and title[1]}")
        faults += [line for line in seen.stderr.splitlines() if "CONSOLE" in line]
        info = output("pdfinfo", paper).stdout
        if "(A4)" not in info:
            faults.append("the PDF is not A4")
        if not re.search(r"Tagged: +yes", info):
            faults.append("the PDF is not tagged")
        # Two lines of headings.
        drawn = len(output("pdfimages", "-list", paper).stdout.splitlines()) - 2
        if drawn != pictures:
            faults.append(f"{drawn} pictures in the PDF, {pictures} in the page")
        words = output("pdftotext", "-layout", paper, "-").stdout
        for figure in {html.unescape(f) for f in re.findall(r"<data [^>]*>([^<]*)</data>", text)}:
            if figure not in words:
                faults.append(f"{figure} is in the page and not in the PDF")
        # Names in other letters are shown, or named where the font has none; all can be copied.
        for name in ["Κουτί", "Zażółć gęślą", "Коробка", "箱"]:
            named = base / f"{name}.obj"
            named.write_text(model.read_text())
            subprocess.run([kerfold, "check", named, "--report", paper, "--quiet"], capture_output=True)
            words = output("pdftotext", "-raw", paper, "-").stdout
            if name not in words:
                faults.append(f"{name} is the name of the model and not in the PDF")
            if ("no glyph for it: U+7BB1" in words) != (name == "箱"):
                faults.append(f"{name}: the note on signs without a glyph is wrong")
    for fault in faults[:50]:
        print("fault:", fault)
    print("report: FAULTS" if faults else "report: as it should be")
    sys.exit(1 if faults else 0)


main()
