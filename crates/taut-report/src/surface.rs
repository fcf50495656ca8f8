//! The report about a surface.

use taut::certify::Surface;
use taut::certify::{SurfaceVerdict, Unused};
use taut::reconstruct::looks_one_sided;
use taut::{PointSource, Solution};

use crate::numbers::{count, counted, exact, short};
use crate::{
    Claims, Field, Report, Summary, rows_of, share, without_outliers, yes_without_outliers,
};

impl Summary for Surface {
    const FOUND: &'static str = "the surface found";

    fn title(report: &Report<'_, Self>) -> String {
        let points = counted(report.points.len(), "point");
        format!("{points} in space: {}", surface_of(report.found))
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let topology = &report.found.answer.topology;
        let components = topology.components.len() as u64;
        let closed =
            topology.components.iter().filter(|one| one.boundary_loops == 0).count() as u64;
        let mut fields = vec![
            Field::new("triangles", count(report.found.answer.triangles.len() as u64)),
            report.vertices(),
            Field::new("components", count(components)).remark(match (components, closed) {
                (0, _) => "no triangle".to_owned(),
                (1, 1) => "closed".to_owned(),
                (1, 0) => "with a boundary".to_owned(),
                (all, closed) if all == closed => "all closed".to_owned(),
                (all, closed) => {
                    format!("{} closed, {} with a boundary", count(closed), count(all - closed))
                }
            }),
        ];
        if topology.boundary_loops > 0 {
            fields.push(Field::new("boundary loops", count(topology.boundary_loops)));
        }
        fields.push(match topology.genus {
            Some(genus) => Field::new("handles", count(genus)),
            None => {
                Field::new("handles", "not defined").remark("a part is no surface with two sides")
            }
        });
        for (name, wrong) in [
            ("non-manifold edges", topology.non_manifold_edges),
            ("non-manifold vertices", topology.non_manifold_vertices),
        ] {
            if wrong > 0 {
                fields.push(Field::new(name, count(wrong)));
            }
        }
        if topology.components.iter().any(|one| !one.orientable) {
            let which = if components == 1 { "the surface" } else { "a part" };
            let remark = format!("{which} cannot be turned alike throughout, as a Möbius band");
            fields.push(Field::new("sides", "one").remark(remark));
        } else if looks_one_sided(report.found) {
            fields.push(Field::new("sides", "in doubt").remark(
                "what cells say contradicts itself: noise, too few points, or a sheet with one side, here cut open",
            ));
        }
        fields.extend(unused(&report.found.answer.unused));
        match &report.verdict {
            Some(proved) => {
                fields.extend(certified(proved));
                let what = match proved.is_delaunay && proved.is_embedded {
                    true => {
                        "topology, empty balls, and that it meets itself nowhere, by exact signs"
                    }
                    false => "topology, and which points are used, by exact signs",
                };
                fields.push(Field::new("verified", "yes").remark(what));
            }
            None => fields.push(Field::new("verified", "not checked")),
        }
        fields.push(Field::new("method", &*report.found.trace.method));
        fields
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.points.dim()
    }

    fn claims(
        found: &Solution<Self>,
        verdict: &Self::Verdict,
        _source: &dyn PointSource,
    ) -> Claims {
        let word = |is| if is { "yes" } else { "no" };
        // The meaning of a word is printed where the word holds.
        let shown = |name, is, meaning: &str| match is {
            true => Field::proved(name, word(is)).remark(meaning),
            false => Field::proved(name, word(is)),
        };
        let empty_balls = match verdict.outliers {
            0 => "each triangle has an empty ball",
            _ => "each triangle has a ball without points but outliers",
        };
        let mut fields = vec![
            Field::proved("triangles", count(verdict.triangles)),
            Field::proved("components", count(verdict.components)),
            Field::proved("boundary loops", count(verdict.boundary_loops)),
            Field::proved("manifold", word(verdict.is_manifold)),
            shown("embedded", verdict.is_embedded, "it meets itself nowhere"),
            shown("delaunay", verdict.is_delaunay, empty_balls),
        ];
        if let Some(genus) = verdict.genus {
            fields.insert(3, Field::proved("handles", count(genus)));
        }
        if verdict.displacement > 0.0 {
            fields.push(
                Field::proved("displacement", exact(verdict.displacement))
                    .remark("no vertex is farther from its point"),
            );
        }
        let unused = &found.answer.unused;
        let lists = [
            ("duplicates", unused.duplicates.len(), "in the place of an earlier row"),
            ("outliers", unused.outliers.len(), "left out: nothing is claimed of them"),
            ("inside", unused.interior.len(), "points that no triangle has, inside the surface"),
            ("unreferenced", unused.unreferenced.len(), "points that no triangle has"),
        ];
        for (name, rows, meaning) in lists {
            if rows > 0 {
                fields.push(Field::proved(name, share(rows as u64, verdict.rows)).remark(meaning));
            }
        }
        fields.extend(certified(verdict));
        let (used, all, left_out) = (verdict.vertices, verdict.rows, verdict.outliers);
        let rows = without_outliers(used, all, left_out, "in space");
        Claims { what: format!("{} through {rows}", surface_of(found)), gap: None, fields }
    }
}

impl Report<'_, Surface> {
    fn vertices(&self) -> Field {
        let used = self.found.answer.topology.vertices;
        let field = Field::new("vertices", count(used));
        match self.found.certificate.displacement {
            _ if used == 0 => field,
            0.0 => field.remark("each is a point of the input"),
            moved => {
                field.remark(format!("points of the input, moved by at most {}", short(moved)))
            }
        }
    }
}

/// Returns what kind it is: "a closed surface with 8 handles".
pub fn surface_of(found: &Solution<Surface>) -> String {
    let topology = &found.answer.topology;
    match (&topology.components[..], topology.genus) {
        ([], _) => "no surface".to_owned(),
        ([one], Some(handles)) => {
            let kind = if one.boundary_loops == 0 { "a closed surface" } else { "a surface" };
            match handles {
                0 => kind.to_owned(),
                _ => format!("{kind} with {}", counted(handles, "handle")),
            }
        }
        ([one], None) if !one.orientable => "a surface with one side".to_owned(),
        ([_], None) => "triangles that are no surface".to_owned(),
        (all, _) if topology.non_manifold_edges + topology.non_manifold_vertices > 0 => {
            format!("{} parts that are no surface", count(all.len() as u64))
        }
        (all, _) => format!("{} surfaces", count(all.len() as u64)),
    }
}

/// The rows that no triangle has, by reason.
fn unused(rows: &Unused) -> Vec<Field> {
    let wide = |rows: &[u32]| rows.iter().map(|&row| u64::from(row)).collect::<Vec<_>>();
    let duplicates: Vec<u32> = rows.duplicates.iter().map(|pair| pair[0]).collect();
    let lists = [
        ("duplicates", &duplicates),
        ("outliers", &rows.outliers),
        ("inside", &rows.interior),
        ("unreferenced", &rows.unreferenced),
    ];
    let lists = lists.into_iter().filter(|(_, rows)| !rows.is_empty());
    lists.map(|(name, rows)| rows_of(name, &wide(rows))).collect()
}

/// What is proved of the surface as such, what its method says of its topology, and both together.
fn certified(verdict: &SurfaceVerdict) -> [Field; 3] {
    const SOUND: &str = "an oriented manifold of Delaunay triangles that meets itself nowhere";
    let doubt = verdict.doubt.map(|doubt| format!("{doubt}; all counted from 0"));
    let sound = match &doubt {
        Some(doubt) if !verdict.is_sound => Field::proved("sound", "no").remark(doubt),
        _ => Field::proved("sound", yes_without_outliers(verdict.rows, verdict.outliers))
            .remark(SOUND),
    };
    let topology = match &doubt {
        Some(doubt) if verdict.is_sound => Field::evidence("topology", "in doubt").remark(doubt),
        _ if verdict.is_confident => Field::evidence("topology", "no doubt").remark(
            "nothing that the method looks at speaks against it; what was sampled is not known",
        ),
        _ => Field::evidence("topology", "in doubt"),
    };
    let certified = match verdict.certified {
        true => {
            Field::evidence("certified", "yes").remark("sound, and no doubt about its topology")
        }
        false => Field::evidence("certified", "no"),
    };
    [sound, topology, certified]
}
