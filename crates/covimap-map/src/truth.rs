//! Surveyed positions, to compare a map with.

use std::path::Path;

use covimap_embed::Point;
use rustc_hash::FxHashSet;

use crate::{LandmarkNames, MapError};

/// Known positions of landmarks, in any unit and frame.
///
/// The file format is CSV with a header line that names the columns `id`, `x` and `y`, in any
/// order; other columns are ignored. White space around values is ignored.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Truth {
    names: LandmarkNames,
    positions: Vec<Point>,
}

impl Truth {
    /// Reads the CSV file at `path`.
    ///
    /// # Errors
    /// [`MapError::Io`] when the file cannot be read, else those of [`Truth::parse`].
    pub fn read(path: &Path) -> Result<Self, MapError> {
        let text = std::fs::read(path).map_err(|source| MapError::Io {
            path: path.to_owned(),
            what: "cannot be read; give a CSV file with the columns id,x,y".to_owned(),
            source,
        })?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Reads CSV text; `file` is what errors call it.
    ///
    /// # Errors
    /// [`MapError::BadLine`] when a column is missing from the header, a row has another number of
    /// fields than the header, an ID is empty or stands there twice, or a coordinate is not a finite number.
    pub fn parse(text: &[u8], file: &str) -> Result<Self, MapError> {
        let bad_line = |at: Option<&csv::Position>, what| {
            let line = line_of(text, at.map_or(0, csv::Position::byte));
            MapError::BadLine { file: file.to_owned(), line, what }
        };
        let broken = |error: csv::Error| bad_line(error.position(), explained(&error));
        let mut csv = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text);
        let columns = Columns::find(csv.headers().map_err(broken)?).map_err(|what| bad_line(None, what))?;
        let mut truth = Self::default();
        let mut known = FxHashSet::default();
        let mut row = csv::StringRecord::new();
        while csv.read_record(&mut row).map_err(broken)? {
            let (id, position) = columns.parse(&row).map_err(|what| bad_line(row.position(), what))?;
            if !known.insert(id.to_owned()) {
                let what = format!("landmark {id:?} stands here again; keep one row");
                return Err(bad_line(row.position(), what));
            }
            truth.names.push(id);
            truth.positions.push(position);
        }
        Ok(truth)
    }

    /// String IDs, in file order.
    #[must_use]
    pub fn names(&self) -> &LandmarkNames {
        &self.names
    }

    /// Positions, in the order of [`Truth::names`].
    #[must_use]
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }
}

/// Where the three columns are.
struct Columns {
    id: usize,
    x: usize,
    y: usize,
}

impl Columns {
    fn find(header: &csv::StringRecord) -> Result<Self, String> {
        let column = |name: &str| {
            header.iter().position(|field| field.eq_ignore_ascii_case(name)).ok_or_else(|| {
                let found: Vec<_> = header.iter().collect();
                format!("the header lacks `{name}`, it has `{}`; it must name id,x,y", found.join(","))
            })
        };
        Ok(Self { id: column("id")?, x: column("x")?, y: column("y")? })
    }

    fn parse<'a>(&self, row: &'a csv::StringRecord) -> Result<(&'a str, Point), String> {
        let id = &row[self.id];
        if id.is_empty() {
            return Err("the id is empty; name the landmark as the log does".to_owned());
        }
        Ok((id, [coordinate("x", &row[self.x])?, coordinate("y", &row[self.y])?]))
    }
}

fn coordinate(name: &str, text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if f64::is_finite(value) => Ok(value),
        Ok(_) => Err(format!("{name} is {text}, positions must be finite; leave the row out")),
        Err(_) => Err(format!("{name} is {text:?}, which is no number; use digits and a decimal point")),
    }
}

/// The line, counted from 1, of the record that starts at `byte` or after the empty lines there.
fn line_of(text: &[u8], byte: u64) -> u64 {
    let start = usize::try_from(byte).map_or(text.len(), |byte| byte.min(text.len()));
    let empty = text[start..].iter().take_while(|&&b| b == b'\r' || b == b'\n').count();
    1 + text[..start + empty].iter().filter(|&&b| b == b'\n').count() as u64
}

fn explained(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("the row has {len} fields, the header {expected_len}; give every row the same fields")
        }
        csv::ErrorKind::Utf8 { .. } => "the text is not UTF-8; save the file as UTF-8".to_owned(),
        _ => format!("{error}; give a CSV file with the columns id,x,y"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Truth, MapError> {
        Truth::parse(text.as_bytes(), "t.csv")
    }

    fn refusal(text: impl AsRef<[u8]>) -> String {
        Truth::parse(text.as_ref(), "t.csv").unwrap_err().to_string()
    }

    #[test]
    fn columns_are_found_by_name_and_others_ignored() {
        let truth = parse("z, Y ,id,x\n0,2.5, A ,-1e3\n0,4,\"B, the second\",3\n").unwrap();
        assert_eq!(truth.names().iter().collect::<Vec<_>>(), ["A", "B, the second"]);
        assert_eq!(truth.positions(), [[-1000.0, 2.5], [3.0, 4.0]]);
    }

    #[test]
    fn a_byte_order_mark_windows_lines_and_a_missing_last_line_end_are_fine() {
        let truth = parse("\u{feff}id,x,y\r\nA,1,2\r\n\r\nB,3,4").unwrap();
        assert_eq!(truth.positions(), [[1.0, 2.0], [3.0, 4.0]]);
    }

    #[test]
    fn a_header_alone_is_a_truth_without_landmarks() {
        assert!(parse("id,x,y\n").unwrap().names().is_empty());
    }

    #[test]
    fn what_is_wrong_is_said_with_file_and_line() {
        assert_eq!(refusal(""), "t.csv:1: the header lacks `id`, it has ``; it must name id,x,y");
        assert_eq!(
            refusal("A,1,2\nB,2,3\n"),
            "t.csv:1: the header lacks `id`, it has `A,1,2`; it must name id,x,y"
        );
        assert_eq!(
            refusal("id,x\nA,1\n"),
            "t.csv:1: the header lacks `y`, it has `id,x`; it must name id,x,y"
        );
        assert_eq!(
            refusal("id,x,y\nA,1,2\nB,1,2,3\n"),
            "t.csv:3: the row has 4 fields, the header 3; give every row the same fields"
        );
        assert_eq!(
            refusal("id,x,y\nA,1,2\n\nB,1,\"2,5\"\n"),
            "t.csv:4: y is \"2,5\", which is no number; use digits and a decimal point"
        );
        assert_eq!(
            refusal("id,x,y\nA,NaN,2\n"),
            "t.csv:2: x is NaN, positions must be finite; leave the row out"
        );
        assert_eq!(
            refusal("id,x,y\nA,1,-inf\n"),
            "t.csv:2: y is -inf, positions must be finite; leave the row out"
        );
        assert_eq!(
            refusal("id,x,y\nA,1,2\nB,1,2\nA,3,4\n"),
            "t.csv:4: landmark \"A\" stands here again; keep one row"
        );
        assert_eq!(refusal("id,x,y\n ,1,2\n"), "t.csv:2: the id is empty; name the landmark as the log does");
        assert_eq!(
            refusal(b"id,x,y\nA,1,2\nB\xff,1,2\n"),
            "t.csv:3: the text is not UTF-8; save the file as UTF-8"
        );
    }

    #[test]
    fn lines_are_counted_as_an_editor_does() {
        for (text, line) in [
            ("id,x,y\r\nA,1,2\r\nB,?,2\r\n", 3),
            ("\n\nid,x,y\n\r\n\nA,1,2\nB,?,2", 7),
            ("id,x,y\n\"two\nlines\",1,2\n\nB,?,2\n", 5),
        ] {
            assert!(refusal(text).starts_with(&format!("t.csv:{line}: x is \"?\"")), "{}", refusal(text));
        }
    }

    #[test]
    fn a_path_that_cannot_be_read_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = Truth::read(&folder.path().join("truth.csv")).unwrap_err();
        assert!(
            missing
                .to_string()
                .ends_with("truth.csv: cannot be read; give a CSV file with the columns id,x,y")
        );
        assert!(matches!(Truth::read(folder.path()), Err(MapError::Io { .. })));
    }
}
