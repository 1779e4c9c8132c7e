//! Meshes from arrays and arrays from meshes, each number copied once.

use glam::{DVec2, DVec3};
use kerfold::code::Coded as _;
use kerfold::geom::{Frame, triangulate};
use kerfold::mend::{RepairParams, Soup, SoupFace, repair};
use kerfold::mesh::{BuildError, FaceId, Mesh, MeshBuilder};
use numpy::{
    PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::trouble::{coded, exception};

/// Groups of faces by name.
pub(crate) type Groups<'py> = Vec<(String, PyReadonlyArray1<'py, i64>)>;

/// Does something with a view of an array of whole numbers, whichever of the usual types they have.
macro_rules! with_integers {
    ($array:expr, $kind:ident, |$view:ident| $work:expr) => {
        with_integers!(@ $array, $kind, $view, $work, i64, i32, u32, u64)
    };
    (@ $array:expr, $kind:ident, $view:ident, $work:expr, $($of:ty),*) => {
        $(if let Ok(array) = $array.cast::<$kind<$of>>() {
            let array = array.readonly();
            let $view = array.as_array();
            Some($work)
        } else)* { None }
    };
}

/// A builder with the vertices (n × 3) and faces of arrays: faces are m × k numbers of vertices, or
/// all corners in a row with the places where faces begin and where the last one ends.
pub(crate) fn builder(
    vertices: &PyReadonlyArray2<'_, f64>,
    faces: &Bound<'_, PyAny>,
    offsets: Option<&PyReadonlyArray1<'_, i64>>,
) -> PyResult<MeshBuilder> {
    let places = vertices.as_array();
    if places.ncols() != 3 {
        let (rows, columns) = places.dim();
        let message = format!("vertices are {rows} × {columns}; they are n × 3, in mm");
        return Err(exception(&message, Some("E232".to_owned())));
    }
    let mut builder = MeshBuilder::with_room(
        places.nrows(),
        offsets.map_or(0, |offsets| offsets.len().saturating_sub(1)),
        faces.len().unwrap_or(0),
    );
    for row in places.rows() {
        builder.vertex(DVec3::new(row[0], row[1], row[2]));
    }
    let added = match offsets {
        None => with_integers!(faces, PyArray2, |view| {
            view.rows().into_iter().for_each(|row| {
                builder.face(row.iter().map(|&v| usize::try_from(v).unwrap_or(usize::MAX)));
            });
            Ok(())
        }),
        Some(offsets) => with_integers!(faces, PyArray1, |view| {
            let bounds = offsets.as_array();
            let mut all = Ok(());
            for (from, to) in bounds.iter().zip(bounds.iter().skip(1)) {
                let range = usize::try_from(*from).ok().zip(usize::try_from(*to).ok());
                match range.filter(|&(from, to)| from <= to && to <= view.len()) {
                    Some((from, to)) => {
                        let corners = (from..to).map(|i| view[i]);
                        builder.face(corners.map(|v| usize::try_from(v).unwrap_or(usize::MAX)));
                    }
                    None => all = Err(format!("no corners from {from} to {to}")),
                }
            }
            all
        }),
    };
    match added {
        Some(Ok(())) => Ok(builder),
        Some(Err(message)) => Err(exception(&message, Some("E233".to_owned()))),
        None => Err(PyTypeError::new_err("faces are an array of whole numbers")),
    }
}

/// The mesh of a builder, its groups, and what was mended.
pub(crate) fn built(builder: MeshBuilder) -> Result<Mesh, BuildError> {
    builder.build().map(|(mesh, _)| mesh)
}

/// A mended mesh, for each of its faces the one that it comes from, and what was done.
type Mended = (Mesh, Vec<Option<u32>>, Vec<String>);

/// The surface that faces become when they are mended as `repair` does, and what was done.
pub(crate) fn mended(
    vertices: &PyReadonlyArray2<'_, f64>,
    faces: &[Vec<u32>],
) -> Result<Mended, BuildError> {
    let places = vertices.as_array();
    let positions = places.rows().into_iter().map(|row| DVec3::new(row[0], row[1], row[2]));
    let face = |(i, corners): (usize, &Vec<u32>)| SoupFace {
        corners: corners.clone(),
        source: u32::try_from(i).ok(),
    };
    let mut soup = Soup {
        positions: positions.collect(),
        faces: faces.iter().enumerate().map(face).collect(),
    };
    let repairs = repair(&mut soup, &RepairParams::default());
    let mesh = soup.build(&Mesh::new())?;
    let sources = soup.faces.iter().map(|face| face.source).collect();
    let notes = repairs.done.iter().map(ToString::to_string).collect();
    Ok((mesh, sources, notes))
}

/// Puts faces into groups.
pub(crate) fn set_groups(mesh: &mut Mesh, groups: &Groups<'_>) -> PyResult<()> {
    for (name, faces) in groups {
        for &face in faces.as_array() {
            let id = usize::try_from(face).ok().filter(|&id| id < mesh.face_count());
            let Some(id) = id else {
                let count = mesh.face_count();
                let message =
                    format!("the group `{name}` names face {face}, but there are only {count}");
                return Err(exception(&message, Some("E233".to_owned())));
            };
            mesh.set_group(FaceId::new(id), name);
        }
    }
    Ok(())
}

/// Numbers as an array, moved and not copied.
pub(crate) fn row<T: numpy::Element>(py: Python<'_>, numbers: Vec<T>) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, numbers)
}

/// Numbers as an array of a shape; their count is that of the shape.
pub(crate) fn shaped<'py, T: numpy::Element>(
    py: Python<'py>,
    numbers: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    row(py, numbers).reshape(shape.to_vec())
}

/// Flat points, k × 2.
pub(crate) fn flat<'py>(
    py: Python<'py>,
    points: &[DVec2],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let numbers = points.iter().flat_map(|p| p.to_array()).collect();
    shaped(py, numbers, &[points.len(), 2])
}

/// Points in space, k × 3.
pub(crate) fn spatial<'py>(
    py: Python<'py>,
    points: &[DVec3],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let numbers = points.iter().flat_map(|p| p.to_array()).collect();
    shaped(py, numbers, &[points.len(), 3])
}

/// Ids as arrays have them.
pub(crate) fn whole(id: usize) -> i64 {
    i64::try_from(id).unwrap_or(i64::MAX)
}

/// The exception for faces that are no surface.
pub(crate) fn no_surface(error: &BuildError) -> PyErr {
    let advice = match error {
        BuildError::NotFinite { .. } | BuildError::MissingVertex { .. } => "",
        _ => "; mend=True mends what can be mended",
    };
    exception(&format!("{error}{advice}"), Some(error.code().to_string()))
}

/// The positions of a mesh without gaps, n × 3.
pub(crate) fn positions<'py>(
    py: Python<'py>,
    mesh: &Mesh,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let mut numbers = Vec::with_capacity(3 * mesh.vertex_count());
    mesh.vertices().for_each(|v| numbers.extend(mesh.position(v).to_array()));
    shaped(py, numbers, &[mesh.vertex_count(), 3])
}

/// All corners of the faces of a mesh in a row, and where each face begins and the last one ends.
pub(crate) type Corners<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<i64>>);

pub(crate) fn corners<'py>(py: Python<'py>, mesh: &Mesh) -> Corners<'py> {
    let mut corners = Vec::with_capacity(2 * mesh.edge_count());
    let mut offsets = Vec::with_capacity(mesh.face_count() + 1);
    offsets.push(0);
    for f in mesh.faces() {
        corners.extend(mesh.face_vertices(f).map(|v| whole(v.index())));
        offsets.push(whole(corners.len()));
    }
    (row(py, corners), row(py, offsets))
}

/// The faces in triangles, t × 3, and the face of each: concave faces by their corners in their own
/// planes.
pub(crate) type Triangles<'py> = (Bound<'py, PyArrayDyn<i64>>, Bound<'py, PyArray1<i64>>);

pub(crate) fn triangles<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Triangles<'py>> {
    let (mut corners, mut faces) = (Vec::new(), Vec::new());
    for (i, f) in mesh.faces().enumerate() {
        let ids: Vec<i64> = mesh.face_vertices(f).map(|v| whole(v.index())).collect();
        let frame = mesh.plane(f).filter(|_| ids.len() > 3).map(|plane| Frame::on_plane(&plane));
        let cut = match frame {
            Some(frame) => {
                let flat = mesh.face_positions(f).into_iter().map(|p| frame.flatten(p));
                triangulate(&flat.collect::<Vec<_>>())
            }
            None => (2..ids.len()).map(|k| [0, k - 1, k]).collect(),
        };
        faces.extend(cut.iter().map(|_| whole(i)));
        corners.extend(cut.into_iter().flatten().map(|k| ids[k]));
    }
    let count = faces.len();
    Ok((shaped(py, corners, &[count, 3])?, row(py, faces)))
}

/// Anything with a code as an exception; here so that callers name one place.
pub(crate) fn refused<E: std::fmt::Display + kerfold::code::Coded>(error: E) -> PyErr {
    coded(&error)
}
