//! Files in one archive, stored as they are: no dates, no order but the given one, so the same
//! files are the same bytes. The format is that of PKWARE's APPNOTE, sections 4.3 and 4.4.

/// An archive of named files.
///
/// `None` when a file, a name or the whole is too large for the format (4 GB, 65 535 files).
pub(crate) fn zip(files: &[(String, Vec<u8>)]) -> Option<Vec<u8>> {
    let mut archive = Vec::new();
    let mut directory = Vec::new();
    for (name, bytes) in files {
        let at = u32::try_from(archive.len()).ok()?;
        let entry = entry(name, bytes)?;
        archive.extend(b"PK\x03\x04");
        archive.extend(&entry);
        archive.extend(name.as_bytes());
        archive.extend(bytes);
        directory.extend(b"PK\x01\x02");
        // Made by version 2.0.
        directory.extend(20u16.to_le_bytes());
        directory.extend(&entry);
        // No remark, first disk, plain attributes.
        directory.extend([0; 10]);
        directory.extend(at.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let count = u16::try_from(files.len()).ok()?.to_le_bytes();
    let at = u32::try_from(archive.len()).ok()?;
    let length = u32::try_from(directory.len()).ok()?;
    archive.extend(directory);
    archive.extend(b"PK\x05\x06\0\0\0\0");
    archive.extend(count);
    archive.extend(count);
    archive.extend(length.to_le_bytes());
    archive.extend(at.to_le_bytes());
    archive.extend([0; 2]);
    Some(archive)
}

/// What both headers of a file say: version, names in UTF-8, stored, the first of January 1980.
fn entry(name: &str, bytes: &[u8]) -> Option<Vec<u8>> {
    let length = u32::try_from(bytes.len()).ok()?.to_le_bytes();
    let mut entry = Vec::with_capacity(26);
    for half in [20u16, 1 << 11, 0, 0, 0x21] {
        entry.extend(half.to_le_bytes());
    }
    entry.extend(crc32(bytes).to_le_bytes());
    entry.extend(length);
    entry.extend(length);
    entry.extend(u16::try_from(name.len()).ok()?.to_le_bytes());
    entry.extend([0; 2]);
    Some(entry)
}

/// The check sum of ISO 3309, bit by bit from a table.
fn crc32(bytes: &[u8]) -> u32 {
    let table: Vec<u32> = (0..256u32)
        .map(|i| (0..8).fold(i, |c, _| if c & 1 == 1 { 0xEDB8_8320 ^ (c >> 1) } else { c >> 1 }))
        .collect();
    !bytes.iter().fold(!0, |c, &b| table[((c ^ u32::from(b)) & 0xFF) as usize] ^ (c >> 8))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_sums_are_those_of_the_standard() {
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
        assert_eq!(crc32(b""), 0);
    }

    #[test]
    fn archives_end_with_their_directory() {
        let files = [("a.txt".to_owned(), b"one".to_vec()), ("b/ä.svg".to_owned(), Vec::new())];
        let archive = zip(&files).expect("small files");
        let end = archive.len() - 22;
        let number = |at: usize| {
            u32::from_le_bytes(archive[at..at + 4].try_into().expect("four bytes")) as usize
        };
        assert_eq!(&archive[end..end + 4], b"PK\x05\x06");
        let (length, at) = (number(end + 12), number(end + 16));
        assert_eq!(at + length, end);
        assert_eq!(&archive[at..at + 4], b"PK\x01\x02");
        assert_eq!(archive[end + 10], 2);
        assert_eq!(&archive[30..38], b"a.txtone");
        assert_eq!(zip(&files), Some(archive));
    }
}
