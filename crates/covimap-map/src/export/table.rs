//! CSV: a landmark a row.

use std::io::{self, Write};

use serde::Serialize;

use crate::GlobalMap;

const HEADER: [&str; 7] = ["id", "x", "y", "component", "region", "sightings", "partners"];

#[derive(Serialize)]
struct Row<'a>(&'a str, f64, f64, u32, u32, u32, u32);

/// Writes CSV with the header `id,x,y,component,region,sightings,partners`.
///
/// Coordinates have the fewest digits that read back as the same number.
///
/// # Errors
/// Those of `out`.
pub fn csv(map: &GlobalMap, out: &mut dyn Write) -> io::Result<()> {
    let mut table = ::csv::WriterBuilder::new().has_headers(false).from_writer(out);
    table.write_record(HEADER)?;
    for (id, placed) in map.names().iter().zip(map.landmarks()) {
        let [x, y] = placed.position;
        table.serialize(Row(id, x, y, placed.component, placed.region, placed.sightings, placed.partners))?;
    }
    table.flush()
}
