//! A job that nobody changes: what the classes of the package hold.

use std::path::{Path, PathBuf};

use kerfold::check::{check, details};
use kerfold::code::{Code, Coded as _};
use kerfold::gallery::{bundled_recipe, unpacked};
use kerfold::io::panels_json::panels_json;
use kerfold::io::report::csv::check_csv;
use kerfold::io::report::html::check_html;
use kerfold::io::report::json::{check_json, check_json_with};
use kerfold::io::report::page::{ReportPage, ReportRows};
use kerfold::io::report::pdf::check_pdf;
use kerfold::io::sheet::files::sheet_bytes;
use kerfold::io::{IoError, MeshFormat, WriteOptions, mesh_bytes, read_text};
use kerfold::make::{
    Fabrication, Panelled, fabrication_outputs, lay_out_again, panel_outputs, report_pictures,
    sheet_picture, show_outputs, with_material,
};
use kerfold::mesh::Mesh;
use kerfold::op::OpContext;
use kerfold::panel::PanelElement;
use kerfold::picture::{RenderParams, render_with};
use kerfold::recipe::{self, Recipe, Step, job_outputs};
use kerfold::select::{Context, Selection};
use kerfold::sheet::{SheetFormat, SheetParams};
use numpy::{PyArray1, PyArrayDyn, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{self, Corners, Groups, row, shaped, whole};
use crate::files::{Files, named};
use crate::steps::kind_of;
use crate::trouble::{coded, exception, failed, fault, unread};
use crate::values::{Fields, fields};
use crate::{net, plates, work};

/// What a chain of steps has made so far; nothing of it changes.
#[pyclass(frozen, module = "kerfold._native")]
pub(crate) struct Job {
    job: recipe::Job,
}

/// A mesh of a step that was given by the names of its fields.
fn read_step(verb: &str, kind: Option<&str>, given: &Fields<'_>) -> PyResult<Step> {
    Step::of_fields(kind_of(verb, kind)?, &fields(given)?).map_err(|error| unread(&error))
}

impl Job {
    fn of(job: recipe::Job) -> Self {
        Self { job: job.closed_up() }
    }

    fn mesh(&self) -> PyResult<&Mesh> {
        self.job.mesh().map_err(|error| coded(&error))
    }

    fn fabrication(&self) -> PyResult<&(Fabrication, SheetParams)> {
        let panels = self.job.panelled.is_some();
        let made = self.job.fabrication.as_ref();
        made.ok_or_else(|| fault(if panels { "there are plates, no net" } else { "no net" }))
    }

    /// The drawings of pieces or plates, and how they are drawn.
    fn sheets(&self) -> Option<(&Fabrication, &SheetParams)> {
        let panels = self.job.panelled.as_ref().map(|(made, sheet)| (&made.fabrication, sheet));
        self.job.fabrication.as_ref().map(|(made, sheet)| (made, sheet)).or(panels)
    }

    fn sheet(&self, number: usize) -> PyResult<(&kerfold::sheet::Drawing, &SheetParams)> {
        let (made, sheet) = self.sheets().ok_or_else(|| fault("no sheets"))?;
        let drawing = made.sheets.drawings.get(number);
        Ok((drawing.ok_or_else(|| fault("no such sheet"))?, sheet))
    }
}

/// A sheet: name, width, height, and of each piece its name, x, y and degrees.
type SheetRow = (String, f64, f64, Vec<(String, f64, f64, f64)>);

#[pymethods]
impl Job {
    /// A job without a mesh.
    #[new]
    fn new() -> Self {
        Self { job: recipe::Job::default() }
    }

    /// A job that begins with the mesh of arrays.
    #[staticmethod]
    #[pyo3(signature = (vertices, faces, offsets, groups))]
    fn of_arrays(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        faces: &Bound<'_, PyAny>,
        offsets: Option<PyReadonlyArray1<'_, i64>>,
        groups: Groups<'_>,
    ) -> PyResult<Self> {
        let builder = arrays::builder(&vertices, faces, offsets.as_ref())?;
        let built = work::run(py, |_| arrays::built(builder))?;
        let mut mesh = built.map_err(|error| arrays::no_surface(&error))?;
        arrays::set_groups(&mut mesh, &groups)?;
        Ok(Self { job: recipe::Job::with_mesh(mesh, Vec::new()) })
    }

    /// The same of faces that need not be a surface: they are mended first.
    #[staticmethod]
    fn mended(
        vertices: PyReadonlyArray2<'_, f64>,
        faces: Vec<Vec<u32>>,
        groups: Groups<'_>,
    ) -> PyResult<Self> {
        let count = vertices.as_array().nrows();
        if let Some(v) = faces.iter().flatten().find(|&&v| v as usize >= count) {
            let message = format!("a face names vertex {v}, but there are only {count}");
            return Err(exception(&message, Some("E233".to_owned())));
        }
        let mended = arrays::mended(&vertices, &faces);
        let (mut mesh, sources, notes) = mended.map_err(|error| arrays::no_surface(&error))?;
        for (name, ids) in &groups {
            let ids: std::collections::HashSet<i64> = ids.as_array().iter().copied().collect();
            for (i, source) in sources.iter().enumerate() {
                if source.is_some_and(|source| ids.contains(&i64::from(source))) {
                    mesh.set_group(kerfold::mesh::FaceId::new(i), name);
                }
            }
        }
        Ok(Self { job: recipe::Job::with_mesh(mesh, notes) })
    }

    /// Carries out one step on a copy.
    fn step(
        &self,
        py: Python<'_>,
        verb: &str,
        kind: Option<&str>,
        given: Fields<'_>,
        title: Option<String>,
    ) -> PyResult<Self> {
        let recipe = Recipe { name: title, steps: vec![read_step(verb, kind, &given)?] };
        let mut job = self.job.clone();
        // What was said of earlier steps was said with them.
        job.notes.clear();
        job.with_findings.clear();
        let made =
            work::run(py, |progress| job.carry_on(&recipe, Path::new(""), progress).map(Self::of))?;
        made.map_err(|error| failed(&error))
    }

    /// The pieces on other sheets, as they are; keys are those of an unfold step.
    fn laid_out(&self, py: Python<'_>, given: Fields<'_>, title: &str) -> PyResult<Self> {
        let step = read_step("unfold", None, &given)?;
        let Step::Unfold { sheet, show, .. } = step else { return Err(fault("no unfold step")) };
        let sheet = with_material(&sheet, Path::new("")).map_err(|error| coded(&error))?;
        let sheet = sheet.titled(title);
        let made = &self.fabrication()?.0;
        let laid = work::run(py, |progress| lay_out_again(made, &sheet, progress))?;
        let laid = laid.map_err(|error| coded(&error))?;
        let notes = laid.notes();
        let mut job = self.job.clone();
        (job.fabrication, job.show, job.notes) = (Some((laid, sheet)), show, notes);
        Ok(Self { job })
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.job.notes.clone()
    }

    /// Whether every step reached what was asked of it.
    #[getter]
    fn is_clean(&self) -> bool {
        self.job.with_findings.is_empty()
    }

    #[getter]
    fn has_mesh(&self) -> bool {
        self.job.has_mesh()
    }

    #[getter]
    fn has_net(&self) -> bool {
        self.job.fabrication.is_some()
    }

    #[getter]
    fn has_panels(&self) -> bool {
        self.job.panelled.is_some()
    }

    #[getter]
    fn is_check_asked(&self) -> bool {
        self.job.is_check_asked
    }

    /// Vertices, edges, faces and rims.
    #[getter]
    fn counts(&self) -> PyResult<(usize, usize, usize, usize)> {
        let mesh = self.mesh()?;
        Ok((mesh.vertex_count(), mesh.edge_count(), mesh.face_count(), mesh.hole_count()))
    }

    /// Lowest and highest corner of the box, in mm.
    #[getter]
    fn bounds(&self) -> PyResult<Option<([f64; 3], [f64; 3])>> {
        let bounds = self.mesh()?.bounds();
        Ok(bounds.map(|(low, high)| (low.to_array(), high.to_array())))
    }

    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        arrays::positions(py, self.mesh()?)
    }

    fn corners<'py>(&self, py: Python<'py>) -> PyResult<Corners<'py>> {
        Ok(arrays::corners(py, self.mesh()?))
    }

    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<arrays::Triangles<'py>> {
        arrays::triangles(py, self.mesh()?)
    }

    /// The two vertices of each edge.
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<i64>>> {
        let mesh = self.mesh()?;
        let ends = mesh.edges().flat_map(|e| mesh.edge_vertices(e)).map(|v| whole(v.index()));
        shaped(py, ends.collect(), &[mesh.edge_count(), 2])
    }

    /// Names of groups with their faces, in the order of the names' first use.
    fn groups<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyArray1<i64>>)>> {
        let mesh = self.mesh()?;
        let mut groups: Vec<(&String, Vec<i64>)> =
            mesh.groups().iter().map(|name| (name, Vec::new())).collect();
        for (i, f) in mesh.faces().enumerate() {
            let Some(name) = mesh.group(f) else { continue };
            if let Some((_, faces)) = groups.iter_mut().find(|(known, _)| *known == name) {
                faces.push(whole(i));
            }
        }
        groups.retain(|(_, faces)| !faces.is_empty());
        Ok(groups.into_iter().map(|(name, faces)| (name.clone(), row(py, faces))).collect())
    }

    /// The ids that a selection finds, of `vertices`, `edges` or `faces`.
    fn find<'py>(
        &self,
        py: Python<'py>,
        selection: &str,
        elements: &str,
    ) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let selection: Selection = selection.parse().map_err(arrays::refused)?;
        let mesh = self.mesh()?;
        let found = work::run(py, |progress| {
            let context = Context { mesh, made: self.job.made(), progress };
            Ok(match elements {
                "vertices" => selection.vertices(&context)?.iter().map(|v| v.index()).collect(),
                "edges" => selection.edges(&context)?.iter().map(|e| e.index()).collect(),
                _ => selection.faces(&context)?.iter().map(|f| f.index()).collect(),
            })
        })?;
        let found: Vec<usize> =
            found.map_err(|error: kerfold::select::SelectError| coded(&error))?;
        Ok(row(py, found.into_iter().map(whole).collect()))
    }

    /// The report of a check as JSON; of the limits that a recipe has set, where none are given.
    fn check(&self, py: Python<'_>, given: Option<Fields<'_>>, command: &str) -> PyResult<String> {
        let (mesh, params) = (self.mesh()?, self.check_params(given)?);
        let report = work::run(py, |_| check(mesh, &params))?.map_err(arrays::refused)?;
        Ok(check_json(&report, command))
    }

    /// The report of a check as a file: html, pdf, json or csv.
    fn report<'py>(
        &self,
        py: Python<'py>,
        given: Option<Fields<'_>>,
        format: &str,
        all_rows: bool,
        names: (String, String),
    ) -> PyResult<Bound<'py, PyBytes>> {
        let (mesh, params) = (self.mesh()?, self.check_params(given)?);
        let (title, command) = (names.0.as_str(), names.1.as_str());
        let rows = if all_rows { ReportRows::All } else { ReportRows::Worst };
        let made = work::run(py, |_| {
            let report = check(mesh, &params)?;
            if format == "csv" {
                return Ok(check_csv(&report, command).into_bytes());
            }
            let listed = details(mesh);
            if format == "json" {
                let listed = all_rows.then_some(&listed);
                return Ok(check_json_with(&report, listed, command).into_bytes());
            }
            let pictures = report_pictures(mesh, &report, &RenderParams::default())?;
            let (details, pictures) = (&listed, &pictures);
            let page = ReportPage { title, report: &report, details, pictures, rows, command };
            Ok(if format == "pdf" { check_pdf(&page) } else { check_html(&page).into_bytes() })
        })?;
        let bytes = made.map_err(|error: kerfold::make::MakeError| coded(&error))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The mesh as a file in the format of its path.
    fn model<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        command: Option<String>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let mesh = self.mesh()?;
        let format = MeshFormat::of_path(&path)
            .ok_or_else(|| coded(&IoError::UnknownFormat { path: path.clone() }))?;
        let made = self.job.made().cloned();
        let options = WriteOptions { command, made, ..WriteOptions::default() };
        let bytes = work::run(py, |_| mesh_bytes(format, mesh, &options))?;
        Ok(PyBytes::new(py, &bytes.map_err(arrays::refused)?))
    }

    /// A picture of the mesh as PNG; keys are those of a render step.
    fn render<'py>(&self, py: Python<'py>, given: Fields<'_>) -> PyResult<Bound<'py, PyBytes>> {
        let step = read_step("render", None, &given)?;
        let Step::Render { render, point_out, .. } = step else {
            return Err(fault("no render step"));
        };
        let mesh = self.mesh()?;
        let png = work::run(py, |progress| {
            let made = self.job.made();
            let context = OpContext { made, progress };
            let (shown, marks) = point_out.shown(mesh, made, render.ids, &context)?;
            Ok(render_with(&shown, &render, &marks)?.to_png())
        })?;
        let png = png.map_err(|error: kerfold::make::MakeError| coded(&error))?;
        Ok(PyBytes::new(py, &png))
    }

    fn net<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        net::net_dict(py, &self.fabrication()?.0.net)
    }

    fn plates<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let panelled = self.job.panelled.as_ref().ok_or_else(|| fault("no plates"))?;
        plates::plate_dicts(py, &panelled.0)
    }

    /// The schedule of the plates: panels.json.
    fn schedule(&self, command: &str) -> PyResult<String> {
        let panelled = self.job.panelled.as_ref().ok_or_else(|| fault("no plates"))?;
        let Panelled { plates, schedule, findings, fabrication, .. } = &panelled.0;
        Ok(panels_json(schedule, plates, &fabrication.sheets.layout, findings, command))
    }

    /// The sheets with what lies on them.
    fn sheet_list(&self) -> Vec<SheetRow> {
        let Some((made, _)) = self.sheets() else { return Vec::new() };
        let of_sheet = |sheet: &kerfold::sheet::Sheet| {
            let placed = sheet.placed.iter().map(|p| (p.piece.to_string(), p.x, p.y, p.rotation));
            (sheet.id.to_string(), sheet.width, sheet.height, placed.collect())
        };
        made.sheets.layout.sheets.iter().map(of_sheet).collect()
    }

    /// Share of the sheets that is used, lengths of cuts and scores in mm, and seconds on the
    /// machine where the material says how fast it is.
    fn layout_facts(&self) -> Option<(f64, f64, f64, Option<f64>)> {
        let (made, sheet) = self.sheets()?;
        let layout = &made.sheets.layout;
        let seconds = made.sheets.seconds(sheet);
        Some((layout.density, layout.cut_length, layout.score_length, seconds))
    }

    /// A sheet as a file: svg, dxf, pdf or lbrn2.
    fn sheet_file<'py>(
        &self,
        py: Python<'py>,
        number: usize,
        format: &str,
        command: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let (drawing, sheet) = self.sheet(number)?;
        let known = SheetFormat::ALL.into_iter().find(|known| known.extension() == format);
        let format = known.ok_or_else(|| fault(&format!("no sheet format {format}")))?;
        Ok(PyBytes::new(py, &sheet_bytes(drawing, format, sheet, command)))
    }

    /// A sheet as a picture, PNG.
    fn sheet_png<'py>(
        &self,
        py: Python<'py>,
        number: usize,
        width: u32,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let (drawing, sheet) = self.sheet(number)?;
        let png = sheet_picture(drawing, &sheet.style(), width).map_err(arrays::refused)?;
        Ok(PyBytes::new(py, &png))
    }

    /// What breaks a limit: a code and words.
    fn findings(&self) -> Vec<(String, String)> {
        // `finding F631: …` of sheets, `… (F501)` of operators.
        let coded = |text: &String| {
            let first = text.strip_prefix("finding ").and_then(|rest| rest.split_once(": "));
            let last = || {
                let (words, code) = text.strip_suffix(')')?.rsplit_once(" (")?;
                Code::read(code).filter(|_| code.starts_with('F')).map(|_| (code, words))
            };
            let (code, words) = first.or_else(last)?;
            Some((code.to_owned(), words.to_owned()))
        };
        let of_sheets = self.job.fabrication.iter().flat_map(|(made, _)| made.findings());
        let mut findings: Vec<_> = of_sheets.filter_map(|text| coded(&text)).collect();
        findings.extend(self.job.notes.iter().filter_map(coded));
        let of_plates = self.job.panelled.iter().flat_map(|(made, _)| &made.findings);
        findings.extend(of_plates.map(|finding| {
            let place = match finding.element {
                PanelElement::Node(vertex) => format!("vertex {vertex}"),
                PanelElement::Face(face) => format!("face {face}"),
            };
            let (measured, limit) = (finding.measured, finding.limit);
            (finding.check.code().to_string(), format!("{place}: {measured:.6} over {limit:.6}"))
        }));
        // The notes of some operators have no code.
        if findings.is_empty() {
            let unreached = &self.job.with_findings;
            findings.extend(unreached.iter().map(|step| (String::new(), step.to_string())));
        }
        findings
    }

    /// The files of `kerfold unfold` or `kerfold panels`, whichever was made.
    fn files<'py>(&self, py: Python<'py>, command: &str) -> PyResult<Files<'py>> {
        let files = work::run(py, |_| {
            if let Some((panelled, sheet)) = &self.job.panelled {
                return panel_outputs(panelled, self.job.mesh()?, sheet, command);
            }
            let Some((made, sheet)) = &self.job.fabrication else { return Ok(Vec::new()) };
            let mesh = self.job.mesh().ok();
            let mut files = fabrication_outputs(made, mesh, sheet, command)?;
            if let Some(mesh) = mesh {
                let show = (&self.job.show.from_here(), sheet.letter.labels);
                files.extend(show_outputs(made, mesh, show, &RenderParams::default(), command)?);
            }
            Ok(files)
        })?;
        Ok(named(py, files.map_err(|error| coded(&error))?))
    }

    /// The files of a whole recipe.
    fn all_files<'py>(&self, py: Python<'py>, command: &str) -> PyResult<Files<'py>> {
        let files = work::run(py, |_| job_outputs(&self.job, command))?;
        Ok(named(py, files.map_err(|error| coded(&error))?))
    }

    /// The job without pieces and plates, so that its mesh can be worked on.
    fn bare(&self) -> Self {
        let mut job = self.job.clone();
        (job.fabrication, job.panelled) = (None, None);
        Self { job }
    }
}

impl Job {
    fn check_params(&self, given: Option<Fields<'_>>) -> PyResult<kerfold::check::CheckParams> {
        match given {
            None => Ok(self.job.check.clone()),
            Some(given) => match read_step("check", None, &given)? {
                Step::Check(params) => Ok(params),
                _ => Err(fault("no check step")),
            },
        }
    }
}

/// Runs a recipe: a file, or the name of one that comes with kerfold, or with `text` the TOML text
/// itself, whose files are looked for from the working folder. Returns what it made and its name.
#[pyfunction]
pub(crate) fn run_recipe(
    py: Python<'_>,
    recipe: &str,
    is_text: bool,
    set: Vec<(String, String)>,
) -> PyResult<(Job, Option<String>)> {
    let path = Path::new(recipe);
    let bundled = bundled_recipe(path).filter(|_| !is_text);
    let text = match bundled {
        _ if is_text => recipe.to_owned(),
        Some(file) => file.text.to_owned(),
        None => read_text(path).map_err(|source| {
            let path = path.to_owned();
            coded(&match source.kind() {
                std::io::ErrorKind::NotFound => IoError::Missing { path },
                _ => IoError::Unreadable { path, source },
            })
        })?,
    };
    let parsed = Recipe::parse_with(&text, &set).map_err(|error| coded(&error))?;
    let beside = bundled.map(unpacked).transpose().map_err(|error| coded(&error))?;
    let folder = match &beside {
        Some((_, folder)) => folder.clone(),
        None if is_text => PathBuf::new(),
        None => path.parent().unwrap_or(Path::new("")).to_owned(),
    };
    let job = work::run(py, |progress| recipe::Job::run(&parsed, &folder, progress))?;
    // Here the number of the step says which one.
    Ok((Job { job: job.map_err(|error| coded(&error))? }, parsed.name))
}
