//! Plain tables: the first column to the left, numbers to the right.

use std::fmt::Write;

/// Puts cells in columns two spaces apart; the first row, usually a header, tells how many.
/// No line ends in a space.
///
/// # Panics
/// When a row is longer than the first (bug in covimap).
pub fn render(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let width =
        |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
    let widths: Vec<_> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let lines: Vec<_> = rows.iter().map(|row| line(row, &widths)).collect();
    lines.join("\n")
}

/// A row of text.
pub fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

fn line(cells: &[String], widths: &[usize]) -> String {
    let mut line = String::new();
    for (column, cell) in cells.iter().enumerate() {
        let width = widths[column];
        let written =
            if column == 0 { write!(line, "{cell:<width$}") } else { write!(line, "  {cell:>width$}") };
        written.expect("a string takes all text (bug in covimap)");
    }
    line.truncate(line.trim_end().len());
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_whatever_their_width() {
        let rows = [row(["id", "x", "seen"]), row(["A", "-1.25", "7"]), row(["Ångström", "0.5"])];
        assert_eq!(render(&rows), "id            x  seen\nA         -1.25     7\nÅngström    0.5");
        assert_eq!(render(&[]), "");
    }
}
