//! Numbers out of the buffer of a glTF file: nothing is believed that the bytes do not hold.

use glam::DVec3;

use super::document::{Accessor, Document};
use super::{MOST, broken};
use crate::io::error::ContentFault;

/// Component types.
const BYTE: u32 = 5120;
const UNSIGNED_BYTE: u32 = 5121;
const SHORT: u32 = 5122;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

pub(super) struct Buffers<'a> {
    pub document: &'a Document,
    /// The bytes of buffer 0.
    pub binary: &'a [u8],
}

impl<'a> Buffers<'a> {
    /// How many elements an accessor has.
    pub fn count(&self, number: usize) -> Result<usize, ContentFault> {
        self.accessor(number).map(|accessor| accessor.count)
    }

    /// Points, at most so many.
    pub fn positions(
        &self,
        number: usize,
        most: usize,
    ) -> Result<impl Iterator<Item = DVec3> + 'a, ContentFault> {
        let accessor = self.accessor(number)?;
        let (kind, normalized) = (accessor.component_type, accessor.normalized);
        let width = width(kind).filter(|_| accessor.kind == "VEC3" && kind != UNSIGNED_INT);
        let width = width.ok_or_else(|| broken(format!("accessor {number} holds no points")))?;
        let elements = self.elements(number, 3 * width, most)?;
        Ok(elements.map(move |element| {
            DVec3::from_array(
                [0, 1, 2]
                    .map(|i| number_of(kind, normalized, &element[i * width..(i + 1) * width])),
            )
        }))
    }

    /// Numbers of vertices, each below `below`, at most so many.
    pub fn indices(
        &self,
        number: usize,
        below: usize,
        most: usize,
    ) -> Result<Vec<u32>, ContentFault> {
        let accessor = self.accessor(number)?;
        let width = match accessor.component_type {
            UNSIGNED_BYTE => 1,
            UNSIGNED_SHORT => 2,
            UNSIGNED_INT => 4,
            _ => 0,
        };
        if width == 0 || accessor.kind != "SCALAR" {
            return Err(broken(format!("accessor {number} holds no numbers of vertices")));
        }
        let index = |element: &[u8]| {
            let index = element.iter().rev().fold(0, |all, &byte| all << 8 | u32::from(byte));
            if (index as usize) < below {
                return Ok(index);
            }
            Err(broken(format!("a triangle names vertex {index} of {below}, counted from 0")))
        };
        self.elements(number, width, most)?.map(index).collect()
    }

    fn accessor(&self, number: usize) -> Result<&'a Accessor, ContentFault> {
        let accessor = self.document.accessors.get(number);
        accessor.ok_or_else(|| broken(format!("accessor {number} is not there")))
    }

    /// The bytes of every element.
    fn elements(
        &self,
        number: usize,
        size: usize,
        most: usize,
    ) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>, ContentFault> {
        let accessor = self.accessor(number)?;
        if accessor.sparse.is_some() {
            return Err(broken(format!("accessor {number} is sparse, which is not read")));
        }
        let view = accessor.buffer_view.and_then(|view| self.document.buffer_views.get(view));
        let Some(view) = view else {
            return Err(broken(format!("accessor {number} has no bytes")));
        };
        let buffer = self.document.buffers.get(view.buffer);
        if view.buffer != 0 || buffer.is_none_or(|buffer| buffer.uri.is_some()) {
            return Err(broken("its numbers lie in another file; export it as one file"));
        }
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end.and_then(|end| self.binary.get(view.byte_offset..end));
        let bytes = bytes.and_then(|bytes| bytes.get(accessor.byte_offset..));
        let stride = view.byte_stride.unwrap_or(size);
        let count = accessor.count;
        let needed = match count.checked_sub(1) {
            None => Some(0),
            Some(before) => before.checked_mul(stride).and_then(|start| start.checked_add(size)),
        };
        let fits = bytes.zip(needed).is_some_and(|(bytes, needed)| needed <= bytes.len());
        let Some(bytes) = bytes.filter(|_| fits && stride >= size) else {
            return Err(broken(format!("accessor {number} reaches beyond its bytes")));
        };
        if count > most {
            return Err(ContentFault::TooMuchMesh { most: MOST });
        }
        Ok((0..count).map(move |i| &bytes[i * stride..i * stride + size]))
    }
}

/// Bytes of a component.
fn width(kind: u32) -> Option<usize> {
    match kind {
        BYTE | UNSIGNED_BYTE => Some(1),
        SHORT | UNSIGNED_SHORT => Some(2),
        UNSIGNED_INT | FLOAT => Some(4),
        _ => None,
    }
}

/// A coordinate; whole numbers stand for parts of 1 when they are normalized.
fn number_of(kind: u32, normalized: bool, bytes: &[u8]) -> f64 {
    let part = |value: f64, whole: f64| {
        if normalized { (value / whole).max(-1.0) } else { value }
    };
    match (kind, bytes) {
        (BYTE, &[a]) => part(f64::from(a as i8), 127.0),
        (UNSIGNED_BYTE, &[a]) => part(f64::from(a), 255.0),
        (SHORT, &[a, b]) => part(f64::from(i16::from_le_bytes([a, b])), 32767.0),
        (UNSIGNED_SHORT, &[a, b]) => part(f64::from(u16::from_le_bytes([a, b])), 65535.0),
        (FLOAT, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        _ => f64::NAN,
    }
}
