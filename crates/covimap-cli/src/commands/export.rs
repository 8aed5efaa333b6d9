//! `covimap export`: a map for other programs, or to look at.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::ValueEnum;
use covimap_map::export::{self, SvgParams};
use covimap_map::{GlobalMap, Truth, output};

use crate::console::Console;
use crate::interrupt::Deferral;
use crate::options::conflict;

/// Write a map in another format
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Map file; `-` is stdin
    #[arg(value_name = "MAP.json")]
    map: PathBuf,
    /// Format to write
    #[arg(long, value_enum, value_name = "FORMAT")]
    to: Target,
    /// Where it goes; `-` is stdout
    #[arg(short, long, value_name = "OUT", default_value = "-")]
    output: PathBuf,
    /// Svg only: surveyed positions to draw beside the map's own, CSV with the columns id,x,y
    #[arg(long, value_name = "TRUTH.csv")]
    truth: Option<PathBuf>,
    /// Nav2-route only: the component whose graph is written [default: 0, the largest]
    #[arg(long, value_name = "N")]
    component: Option<u32>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Target {
    /// Table of landmarks: id,x,y,component and more
    Csv,
    /// Picture
    Svg,
    /// Landmarks and Delaunay edges for GIS programs
    Geojson,
    /// Landmarks and Delaunay edges for graph programs
    Graphml,
    /// Landmarks and Delaunay edges for point cloud viewers
    Ply,
    /// Landmarks and lines of sight of one component for the route server of Nav2
    Nav2Route,
    /// The map file itself, as JSON
    Json,
    /// The map file itself, in the binary form that loads fastest
    Binary,
}

/// Writes one format.
type Writer<'a> = Box<dyn FnOnce(&mut dyn Write) -> io::Result<()> + 'a>;

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        if self.truth.is_some() && self.to != Target::Svg {
            return Err(conflict("--truth is drawn by --to svg alone; leave it out"));
        }
        if self.component.is_some() && self.to != Target::Nav2Route {
            return Err(conflict("--component belongs to --to nav2-route alone; leave it out"));
        }
        let map = GlobalMap::load(&self.map)?;
        let write: Writer = match self.to {
            Target::Csv => Box::new(|out| export::csv(&map, out)),
            Target::Geojson => Box::new(|out| export::geojson(&map, out)),
            Target::Graphml => Box::new(|out| export::graphml(&map, out)),
            Target::Ply => Box::new(|out| export::ply(&map, out)),
            Target::Json => Box::new(|out| map.write_json(out)),
            Target::Binary => Box::new(|out| map.write_binary(out)),
            Target::Nav2Route => {
                let component = self.component.unwrap_or(0);
                let write = export::nav2_route(&map, component)?;
                if map
                    .alignment()
                    .iter()
                    .all(|fit| fit.component != component || fit.anchors + fit.distances == 0)
                {
                    console.say("the route graph is in map units, not metres: `covimap align` first");
                }
                Box::new(write)
            }
            Target::Svg => {
                let truth = self.truth.as_deref().map(Truth::read).transpose()?;
                let mut params = SvgParams::default();
                params.truth = truth.as_ref();
                let picture = export::svg(&map, &params)?;
                Box::new(move |out| out.write_all(picture.as_bytes()))
            }
        };
        let _deferral = Deferral::of_writing();
        Ok(output::write_whole(&self.output, write)?)
    }
}
