//! The files that the program writes by names of its own. Files whose names the user gives are not
//! here.

use std::fmt::Write;

/// A file: its name with `NN` for a number, who writes it, what it is.
struct File {
    name: &'static str,
    by: &'static str,
    what: &'static str,
}

const fn file(name: &'static str, by: &'static str, what: &'static str) -> File {
    File { name, by, what }
}

const FILES: [File; 37] = [
    file("model.obj", "`run`, `dform`", "the model as it is at the end"),
    file("model.png", "`run`, `dform`", "its picture"),
    file(
        "before.png",
        "`run` with `before = \"on\"` in a step `render`",
        "the model before the last operator: what is cut, opened or joined in red, sections and \
        plane in blue",
    ),
    file(
        "story.png",
        "`run` with `story` in a step `render`",
        "the pictures that the list names, side by side",
    ),
    file(
        "list.png",
        "`dform --list`",
        "the outlines, and the bodies for starts all around the rim",
    ),
    file(
        "model-after-NN.png",
        "`run` with `steps` of a `hull`",
        "a picture of the dual hull after so many planes",
    ),
    file("report.json", "`run`, `dform`", "the report of the check"),
    file("report.html", "`run` with a step `check`", "the same as a page with pictures"),
    file(
        "pieces.json",
        "`unfold`, `dform`, `nest`, `panels`, `run`",
        "the pieces with folds, seams and the proof",
    ),
    file("layout.json", "with sheets", "where each piece lies"),
    file("assembly.txt", "with sheets", "the order in which seams are closed"),
    file("sheets.html", "with sheets", "one page to look at all sheets, beside the model"),
    file("assembly-NN.png", "`--assembly pictures`", "the same as pictures"),
    file("sheet-NN.svg", "with sheets, `--format svg`", "the sheet as SVG in layers"),
    file("sheet-NN.dxf", "with sheets, `--format dxf`", "the sheet as DXF R2000"),
    file("sheet-NN.pdf", "with sheets, `--format pdf`", "the sheet as PDF at true size"),
    file("sheet-NN.lbrn2", "with sheets, `--format lbrn2`", "the sheet as LightBurn project"),
    file("sheet-NN.png", "with sheets", "a picture of the sheet"),
    file(
        "sheet-NN-PAPER.pdf",
        "with sheets, `--tile PAPER`",
        "the sheet at true size on several pages of `a4`, `a3` or `letter`",
    ),
    file(
        "PNN.svg",
        "`--part-files on`",
        "one part, in each of the formats: `.svg`, `.dxf`, `.pdf`, `.lbrn2`",
    ),
    file("panels.json", "`panels`", "panels, groups, edges, nodes, totals, findings"),
    file("panels.csv", "`panels`", "a row for each panel"),
    file("edges.csv", "`panels`", "a row for each edge"),
    file("nodes.csv", "`panels`", "a row for each node"),
    file("cutting-list.csv", "`panels`", "a row for each group of congruent panels"),
    file("schedule.xlsx", "`panels`", "the four tables as one workbook"),
    file("panes.pdf", "`panels`", "a dimensioned drawing of each pane"),
    file("pane-PNN.dxf", "`panels --drawings dxf`", "the same as a DXF at true size"),
    file("assembly-map.svg", "`panels`", "the model from the sides that its panels look at"),
    file("assembly-map.pdf", "`panels`", "the same on A3"),
    file("plates.step", "`panels --solids step`", "the plates as solids (AP214)"),
    file("plates.obj", "`panels --solids obj`", "the plates as meshes"),
    file("plates.mtl", "`panels --solids obj`", "the colours of that file"),
    file("plates.glb", "`panels --solids glb`", "the plates with colours and names"),
    file("plates.stl", "`panels --solids stl`", "the plates as triangles"),
    file("kerfold.1", "`man`", "the manual page of the program"),
    file("kerfold-VERB.1", "`man`", "the manual page of a verb"),
];

pub(super) fn written(page: &mut String) {
    *page += "\n## Files\n\nThese names do not change. `NN` is a number. Verbs that take `-o FILE` \
    write the file that is named and are not listed.\n\n\
              | file | written by | what it is |\n|---|---|---|\n";
    for File { name, by, what } in &FILES {
        let _ = writeln!(page, "| `{name}` | {by} | {what} |");
    }
}
