//! Opaque surfaces in a view: what is seen of them, and what they hide.
//!
//! *Idea.* A depth buffer finer than the pixels decides what is seen. Few flat triangles, those of them that are seen at all, are
//! painted as polygons in an order that shows the same as the buffer, if there is one; else the buffer becomes an image. Lines and
//! points ask the buffer whether something is before them.
//! *Guarantee.* No triangle is left out because there are many.
//! *Trap.* Polygons that pierce or overlap each other in a ring have no such order.

use super::Chrome;
use super::camera::{Camera, V3, add, dot};
use super::canvas::Canvas;
use super::stage::{Stage, finite};
use crate::raster::{Facet, Image, Ramp, Raster, area, normals, order, png, ramp, snap};
use crate::{Scene3, Shading, Shape3, Theme, Tone};

/// Up to this many triangles are polygons; an image of more is smaller than they are.
const POLYGONS_MAX: usize = 4000;

/// Triangles that are held at once: 7 MB of them. More than can be polygons, which are held all.
const FACETS_MAX: usize = 1 << 16;
const _: () = assert!(FACETS_MAX > POLYGONS_MAX);

/// A view has at most this many samples: 160 MB while it is drawn.
const SAMPLES_MAX: usize = 1 << 24;

/// This many samples are wanted to each unit of the picture: four by four for each pixel of a common screen.
const SAMPLES_PER_UNIT: f64 = 4.0;

/// A difference in nearness up to this is none: a line on a surface is not hidden by it.
const NEARNESS_TOLERANCE: f64 = 2e-3;

/// From where light falls, as seen by the eye: right, up, towards it. Of length 1 but for a hundredth.
const LIGHT: V3 = [-0.3, 0.5, 0.81];

/// Light from everywhere, so that what is turned away from the other light still has a shape.
const AMBIENT: f64 = 0.25;

/// A surface in the unit ball.
pub(super) struct Solid {
    /// The tones of its front and its back.
    tones: [Tone; 2],
    shading: Shading,
    places: Vec<V3>,
    triangles: Vec<[u32; 3]>,
    normals: Vec<[V3; 3]>,
}

/// The opaque surfaces of a scene.
pub(super) fn solids(scene: &Scene3, stage: &Stage) -> Vec<Solid> {
    let mut solids = Vec::new();
    for layer in &scene.layers {
        let Shape3::Surface(surface) = &layer.shape else { continue };
        let vertices = &surface.vertices;
        let drawable =
            |t: &&[u32; 3]| t.iter().all(|&i| vertices.get(i as usize).is_some_and(finite));
        let triangles: Vec<_> = surface.triangles.iter().filter(drawable).copied().collect();
        let places: Vec<V3> = vertices.iter().map(|p| stage.place(p)).collect();
        let normals = normals(&places, &triangles, surface.shading);
        let tones = [layer.tone, surface.back];
        solids.push(Solid { tones, shading: surface.shading, places, triangles, normals });
    }
    solids
}

/// The part of a view that surfaces cover.
pub(super) struct Coverage {
    raster: Raster,
    /// Where the first sample begins in the picture.
    origin: [f64; 2],
    /// Samples to each unit of the picture.
    fine: f64,
    marks: Marks,
}

/// Corners and color.
type Polygon = ([[f64; 2]; 3], [u8; 3]);

/// How surfaces are written.
enum Marks {
    /// From back to front.
    Polygons(Vec<Polygon>),
    /// Pixels and their size in units of the picture.
    Beside(Image, [f64; 2]),
    /// A PNG file, likewise.
    Embedded(Vec<u8>, [f64; 2]),
}

impl Coverage {
    /// Finds out what is seen of the surfaces and how to write it; `None` if there is no triangle. `density` is that of the canvas.
    pub(super) fn find(
        solids: &[Solid],
        camera: &Camera,
        mut density: f64,
        chrome: Chrome,
    ) -> Option<Coverage> {
        let count: usize = solids.iter().map(|solid| solid.triangles.len()).sum();
        let turned: Vec<Vec<V3>> = solids
            .iter()
            .map(|solid| solid.places.iter().map(|&p| camera.turn(p)).collect())
            .collect();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (solid, turned) in solids.iter().zip(&turned) {
            for &i in solid.triangles.as_flattened() {
                let at = camera.pixel(turned[i as usize]);
                for k in 0..2 {
                    (low[k], high[k]) = (low[k].min(at[k]), high[k].max(at[k]));
                }
            }
        }
        if count == 0 {
            return None;
        }
        // Pixels of the image are pixels of the picture where it is drawn at its density.
        let size = |density: f64| {
            let pixels =
                |k: usize| ((high[k] * density).ceil() - (low[k] * density).floor()) as usize + 2;
            [pixels(0), pixels(1)]
        };
        while size(density)[0].saturating_mul(size(density)[1]) > SAMPLES_MAX {
            density /= 2.0;
        }
        let [width, height] = size(density);
        let most = ((SAMPLES_MAX / (width * height)) as f64).sqrt();
        let across = (SAMPLES_PER_UNIT / density).ceil().max(2.0).min(most).max(1.0) as usize;
        let fine = density * across as f64;
        let origin = low.map(|x| ((x * density).floor() - 1.0) / density);

        let theme = match chrome {
            Chrome::Full(theme) => theme,
            // The page's own colors change with the screen; those of an image cannot.
            Chrome::Bare => Theme::Light,
        };
        // Two inks for each surface; a scene of more than 127 opaque surfaces has the last colors for the others.
        let inks: Vec<Ramp> =
            solids.iter().take(127).flat_map(|s| s.tones).map(|tone| ramp(theme, tone)).collect();
        let mut raster = Raster::new(width * across, height * across);
        let few = count <= POLYGONS_MAX && solids.iter().all(|s| s.shading == Shading::Flat);
        let mut facets = Vec::new();
        let mut owner = 0_u32;
        for (which, (solid, turned)) in solids.iter().zip(&turned).enumerate() {
            for (triangle, normals) in solid.triangles.iter().zip(&solid.normals) {
                let corners = triangle.map(|i| turned[i as usize]);
                let at = corners.map(|v| {
                    let pixel = camera.pixel(v);
                    snap([0, 1].map(|k| (pixel[k] - origin[k]) * fine))
                });
                let back = area(&at) < 0;
                let towards = if back { -1.0 } else { 1.0 };
                let facet = Facet {
                    corners: at,
                    near: corners.map(|v| camera.nearness(v[2])),
                    light: normals
                        .map(|n| AMBIENT + (1.0 - AMBIENT) * towards * dot(camera.turn(n), LIGHT)),
                    ink: (2 * which.min(126) + usize::from(back)) as u8,
                    owner,
                };
                if facets.len() == FACETS_MAX {
                    raster.fill(&facets);
                    facets.clear();
                }
                facets.push(facet);
                owner = u32::wrapping_add(owner, 1);
            }
        }
        raster.fill(&facets);
        let mut cover = Coverage { raster, origin, fine, marks: Marks::Polygons(Vec::new()) };
        let polygons = if few { cover.polygons(&facets, &inks) } else { None };
        cover.marks = match polygons {
            Some(polygons) => Marks::Polygons(polygons),
            None => {
                let size = [width as f64 / density, height as f64 / density];
                Marks::Beside(cover.raster.image(across, &inks), size)
            }
        };
        Some(cover)
    }

    /// Makes a PNG file of an image.
    pub(super) fn compress(&mut self) {
        if let Marks::Beside(image, size) = &self.marks {
            self.marks = Marks::Embedded(png(image), *size);
        }
    }

    /// Writes the surfaces.
    pub(super) fn write(&mut self, canvas: &mut Canvas) {
        match std::mem::replace(&mut self.marks, Marks::Polygons(Vec::new())) {
            Marks::Polygons(polygons) => {
                canvas.open(
                    "surface",
                    "stroke=\"#000\" stroke-opacity=\".25\" stroke-width=\".5\" stroke-linejoin=\"round\"",
                );
                for (places, color) in &polygons {
                    canvas.polygon(places, *color);
                }
                canvas.close();
            }
            Marks::Embedded(png, size) => canvas.embed(&png, self.origin, size),
            Marks::Beside(image, size) => canvas.lay(image, self.origin, size),
        }
    }

    /// The polygons that are seen, from back to front, if there is an order in which they show what the buffer shows.
    fn polygons(&self, facets: &[Facet], inks: &[Ramp]) -> Option<Vec<Polygon>> {
        let seen = self.raster.seen(facets.len());
        let behind = self.raster.behind(facets, NEARNESS_TOLERANCE as f32);
        let depths: Vec<f64> = facets.iter().map(|facet| facet.near.iter().sum()).collect();
        // Owners are places in the list.
        let order = order(&depths, &behind)?.into_iter().map(|i| &facets[i]);
        let polygon = |facet: &Facet| {
            let light = facet.light.iter().sum::<f64>() / 3.0;
            let shade = (light.clamp(0.0, 1.0) * 255.0).round() as usize;
            let places = facet.corners.map(|corner| self.unsnap(corner));
            (places, inks[usize::from(facet.ink)][shade])
        };
        Some(order.filter(|f| seen[f.owner as usize]).map(polygon).collect())
    }

    /// The place of a corner in the picture.
    fn unsnap(&self, corner: [i64; 2]) -> [f64; 2] {
        [0, 1].map(|k| {
            self.origin[k] + corner[k] as f64 / crate::raster::SNAP_PARTS as f64 / self.fine
        })
    }

    /// Returns true if a turned place is behind a surface.
    pub(super) fn hides(&self, camera: &Camera, v: V3) -> bool {
        let pixel = camera.pixel(v);
        let at = [0, 1].map(|k| (pixel[k] - self.origin[k]) * self.fine);
        // A line on a slope is deeper than the samples before it; beside the rim of a surface some sample is free.
        let reach = (self.fine * 0.75).ceil() as i64;
        self.raster.hides(at, camera.nearness(v[2]), reach, NEARNESS_TOLERANCE)
    }

    /// A segment in parts that are hidden and parts that are not.
    pub(super) fn runs(&self, camera: &Camera, [a, b]: [V3; 2]) -> Vec<([V3; 2], bool)> {
        let [from, to] = [camera.pixel(a), camera.pixel(b)];
        let steps = ((to[0] - from[0]).hypot(to[1] - from[1]) / 1.5).ceil().clamp(1.0, 4000.0);
        let along = |t: f64| add(a, add(b, a, -1.0), t / steps);
        let mut runs: Vec<([V3; 2], bool)> = Vec::new();
        for step in 0..steps as u32 {
            let step = f64::from(step);
            let (hidden, end) = (self.hides(camera, along(step + 0.5)), along(step + 1.0));
            match runs.last_mut() {
                Some((last, same)) if *same == hidden => last[1] = end,
                _ => runs.push(([along(step), end], hidden)),
            }
        }
        runs
    }
}
