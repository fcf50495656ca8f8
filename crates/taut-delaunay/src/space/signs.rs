//! The operations that walk and cavity need, and the answers that need no vectors.
//!
//! The filters are written once, over a [`Lane`] of numbers: one `f64` here, four or eight in `lanes`. A filter gives a
//! determinant and a bound on its error; a sign it leaves open goes to the [`Judge`].

use std::marker::PhantomData;
use std::ops::{Add, Mul, Sub};

use taut_predicates::{Exact, MulAdd, Separate, Sign, Stages, space};

use crate::kernel::Settings;
use crate::threads::Slot;

use super::cavity::{FACETS, Facet, ghost_place};
use super::{Site, row};

/// The error of [`orientation`] in units of its bound. The bound takes the largest differences for each factor, where
/// the predicates' own takes the permanent: 6 monomials, and a little more for the rounding of the bound itself.
const ORIENTATION_ERROR: f64 = 6.1 * space::ORIENT_ERROR;
/// The error of [`in_sphere`] in units of its bound: 4 · 6 · 3 = 72 monomials, and a little more.
const IN_SPHERE_ERROR: f64 = 73.0 * space::IN_SPHERE_ERROR;

/// The operations of a determinant.
pub(super) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// a·b + c.
    fn mul_add(a: Self, b: Self, c: Self) -> Self;
    /// a·b − c.
    fn mul_sub(a: Self, b: Self, c: Self) -> Self;
}

/// Numbers side by side.
pub(super) trait Lane: Number {
    /// The same number in each.
    fn splat(value: f64) -> Self;
    /// The larger; if one of the two is NaN, either.
    fn max(self, other: Self) -> Self;
    /// Without its sign.
    fn abs(self) -> Self;
}

// From here to the answers no closure and no `map`: a closure is compiled on its own first, without the instructions of
// the function it ends up in, and then every sum becomes a call (4900 ns per site instead of 900).

/// The largest magnitude of three.
#[inline(always)]
fn largest<L: Lane>(a: L, b: L, c: L) -> L {
    a.abs().max(b.abs()).max(c.abs())
}

/// The minor uₓvᵧ − uᵧvₓ.
#[inline(always)]
fn minor<N: Number>(u: [N; 3], v: [N; 3]) -> N {
    N::mul_sub(u[0], v[1], u[1] * v[0])
}

/// |u|².
#[inline(always)]
pub(super) fn lift<N: Number>(u: [N; 3]) -> N {
    N::mul_add(u[2], u[2], N::mul_add(u[1], u[1], u[0] * u[0]))
}

/// det[a; b; c] and the bound of its error: the orientation of the origin, a, b, c.
#[inline(always)]
pub(super) fn orientation<L: Lane>([a, b, c]: [[L; 3]; 3]) -> (L, L) {
    let det = L::mul_add(a[2], minor(b, c), L::mul_sub(c[2], minor(a, b), b[2] * minor(a, c)));
    let x = largest(a[0], b[0], c[0]);
    let y = largest(a[1], b[1], c[1]);
    let z = largest(a[2], b[2], c[2]);
    (det, L::mul_add(L::splat(ORIENTATION_ERROR) * x, y * z, L::splat(space::UNDERFLOW_ERROR)))
}

/// The cofactors bcd, −cda, dab, −abc of the lifts in the in-sphere determinant.
#[inline(always)]
pub(super) fn cofactors<N: Number>([a, b, c, d]: [[N; 3]; 4]) -> [N; 4] {
    let (ab, bc, cd) = (minor(a, b), minor(b, c), minor(c, d));
    let (ad, ac, bd) = (minor(a, d), minor(a, c), minor(b, d));
    [
        N::mul_add(b[2], cd, N::mul_sub(d[2], bc, c[2] * bd)),
        N::mul_sub(c[2], ad, N::mul_add(d[2], ac, a[2] * cd)),
        N::mul_add(d[2], ab, N::mul_sub(a[2], bd, b[2] * ad)),
        N::mul_sub(b[2], ac, N::mul_add(c[2], ab, a[2] * bc)),
    ]
}

/// The in-sphere determinant |a|²bcd − |b|²cda + |c|²dab − |d|²abc: positive if the origin is inside the sphere through
/// the positive simplex a, b, c, d.
#[inline(always)]
pub(super) fn determinant<N: Number>(corners: [[N; 3]; 4]) -> N {
    let [u, v, w, t] = cofactors(corners);
    let [a, b, c, d] = corners;
    N::mul_add(lift(a), u, lift(b) * v) + N::mul_add(lift(c), w, lift(d) * t)
}

/// The largest difference along each axis.
#[inline(always)]
pub(super) fn extents<L: Lane>([a, b, c, d]: [[L; 3]; 4]) -> [L; 3] {
    [
        largest(a[0], b[0], c[0]).max(d[0].abs()),
        largest(a[1], b[1], c[1]).max(d[1].abs()),
        largest(a[2], b[2], c[2]).max(d[2].abs()),
    ]
}

/// Returns what the largest monomial of [`determinant`] cannot exceed.
#[inline(always)]
pub(super) fn product<L: Lane>(corners: [[L; 3]; 4]) -> L {
    let [x, y, z] = extents(corners);
    let reach = x.max(y).max(z);
    (x * y) * (z * (reach * reach))
}

/// The in-sphere determinant and the bound of its error.
#[inline(always)]
pub(super) fn in_sphere<L: Lane>(corners: [[L; 3]; 4]) -> (L, L) {
    let bound =
        L::mul_add(L::splat(IN_SPHERE_ERROR), product(corners), L::splat(space::UNDERFLOW_ERROR));
    (determinant(corners), bound)
}

/// The way in which the signs are taken. Masks have a bit for each item; what is in neither mask is certainly negative.
pub(super) trait Signs: Copy {
    /// States whether numbers are asked before exact arithmetic is.
    const FILTERED: bool;

    /// The number of conflicts that are tested at once.
    const WIDTH: usize;

    /// Which of `WIDTH` simplices are certainly in conflict with q, and which are open. Ghosts are open.
    fn conflicts(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> (u32, u32);

    /// The same with pairs of numbers, if this path has them.
    fn conflicts_in_pairs(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> Option<(u32, u32)>;

    /// The same for whole numbers, if this path has that, and which were ties.
    fn conflicts_in_whole(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> Option<(u32, u32, u32)>;

    /// Beyond which facets of a positive simplex q certainly lies, and which are open.
    fn beyond(self, corners: [&Site; 4], q: &Site) -> (u32, u32);

    /// Has memory brought near that will soon be read; the address need not be valid.
    #[inline(always)]
    fn fetch<T>(self, _address: *const T) {}

    /// Writes facet I of a simplex.
    #[inline(always)]
    fn put<const I: usize>(self, simplex: &impl Slot<4>, facet: &mut Facet) {
        let vertices = FACETS[I].map(|i| simplex.vertex(i));
        *facet = Facet { vertices, outside: simplex.neighbor(I) };
    }
}

/// One at a time.
#[derive(Clone, Copy)]
pub(super) struct Scalar<M>(pub(super) PhantomData<M>);

/// One `f64`, with the multiplication and addition of `M`.
#[derive(Clone, Copy)]
struct Real<M>(f64, PhantomData<M>);

impl<M> Real<M> {
    #[inline(always)]
    fn new(value: f64) -> Self {
        Real(value, PhantomData)
    }
}

impl<M> Add for Real<M> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.0 + other.0)
    }
}

impl<M> Sub for Real<M> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.0 - other.0)
    }
}

impl<M> Mul for Real<M> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.0 * other.0)
    }
}

impl<M: MulAdd> Number for Real<M> {
    #[inline(always)]
    fn mul_add(a: Self, b: Self, c: Self) -> Self {
        Self::new(M::mul_add(a.0, b.0, c.0))
    }
    #[inline(always)]
    fn mul_sub(a: Self, b: Self, c: Self) -> Self {
        Self::new(M::mul_add(a.0, b.0, -c.0))
    }
}

impl<M: MulAdd> Lane for Real<M> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::new(value)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // One instruction, where `f64::max` has to look for NaN.
        Self::new(if self.0 > other.0 { self.0 } else { other.0 })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::new(self.0.abs())
    }
}

/// The rows of the vertices.
#[inline(always)]
pub(super) fn rows(sites: &[Site], vertices: [u32; 4]) -> [&Site; 4] {
    let [a, b, c, d] = vertices;
    [&sites[row(a)], &sites[row(b)], &sites[row(c)], &sites[row(d)]]
}

/// p − q, as a lane.
#[inline(always)]
fn less<M>(p: &Site, q: &Site) -> [Real<M>; 3] {
    [Real::new(p.0[0] - q.0[0]), Real::new(p.0[1] - q.0[1]), Real::new(p.0[2] - q.0[2])]
}

impl<M: MulAdd> Signs for Scalar<M> {
    const FILTERED: bool = true;
    const WIDTH: usize = 1;

    #[inline(always)]
    fn conflicts(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> (u32, u32) {
        let [a, b, c, d] = rows(sites, simplices[group[0] as usize].vertices());
        let (Real(det, _), Real(bound, _)) =
            in_sphere([less::<M>(a, q), less(b, q), less(c, q), less(d, q)]);
        let inside = det > bound;
        (u32::from(inside), u32::from(!(inside || det < -bound)))
    }

    fn conflicts_in_pairs(
        self,
        _: &[Site],
        _: &[impl Slot<4>],
        _: &[u32],
        _: &Site,
    ) -> Option<(u32, u32)> {
        None
    }

    fn conflicts_in_whole(
        self,
        _: &[Site],
        _: &[impl Slot<4>],
        _: &[u32],
        _: &Site,
    ) -> Option<(u32, u32, u32)> {
        None
    }

    #[inline(always)]
    fn beyond(self, corners: [&Site; 4], q: &Site) -> (u32, u32) {
        let [a, b, c, d] = corners;
        let corners = [less::<M>(a, q), less(b, q), less(c, q), less(d, q)];
        let (mut beyond, mut open) = (0, 0);
        for i in 0..FACETS.len() {
            let [a, b, c] = FACETS[i];
            let (Real(det, _), Real(bound, _)) = orientation([corners[a], corners[b], corners[c]]);
            let out = det < -bound;
            beyond |= u32::from(out) << i;
            open |= u32::from(!(out || det > bound)) << i;
        }
        (beyond, open)
    }
}

/// Leaves every sign to the exact stages: for coordinates too large or too small to be filtered.
#[derive(Clone, Copy)]
pub(super) struct Unfiltered;

impl Signs for Unfiltered {
    const FILTERED: bool = false;
    const WIDTH: usize = 1;

    fn conflicts(self, _: &[Site], _: &[impl Slot<4>], _: &[u32], _: &Site) -> (u32, u32) {
        (0, 1)
    }

    fn conflicts_in_pairs(
        self,
        _: &[Site],
        _: &[impl Slot<4>],
        _: &[u32],
        _: &Site,
    ) -> Option<(u32, u32)> {
        None
    }

    fn conflicts_in_whole(
        self,
        _: &[Site],
        _: &[impl Slot<4>],
        _: &[u32],
        _: &Site,
    ) -> Option<(u32, u32, u32)> {
        None
    }

    fn beyond(self, _: [&Site; 4], _: &Site) -> (u32, u32) {
        (0, 0b1111)
    }
}

/// Decides what the filters leave open.
pub(super) struct Judge {
    exact: Exact,
    /// In-sphere tests of the simplices behind ghosts.
    behind: u64,
}

impl Judge {
    pub(super) fn new(settings: Settings) -> Self {
        Judge { exact: Exact::new(settings.integral), behind: 0 }
    }

    /// The exact stages so far, and how many tests ghosts passed on.
    pub(super) fn into_parts(self) -> (Stages, u64) {
        (self.exact.stages, self.behind)
    }

    /// The orientation of a, b, c, d.
    pub(super) fn orient(&mut self, corners: [&Site; 4]) -> Sign {
        let [a, b, c, d] = corners;
        space::orient_exact(a.point(), b.point(), c.point(), d.point(), &mut self.exact)
    }

    /// Which of the open simplices of a group are in conflict with q.
    #[inline(never)]
    pub(super) fn conflicts<S: Signs>(
        &mut self,
        signs: S,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        open: u32,
        q: &Site,
    ) -> u32 {
        let (mut inside, mut finite, mut left) = (0u32, 0u32, open);
        while left != 0 {
            let lane = left.trailing_zeros();
            left &= left - 1;
            let simplex = &simplices[group[lane as usize] as usize];
            match ghost_place(simplex.vertices()) {
                None => finite |= 1 << lane,
                Some(place) => {
                    let beyond = self.beyond::<S, _>(sites, simplices, simplex, place, q);
                    inside |= u32::from(beyond) << lane;
                }
            }
        }
        let stages = &mut self.exact.stages;
        if self.exact.integral && finite.count_ones() > 1 {
            let answer = signs.conflicts_in_whole(sites, simplices, group, q);
            if let Some((certain, unsure, ties)) = answer {
                inside |= certain & finite;
                stages.integer += u64::from((finite & !unsure).count_ones());
                stages.ties += u64::from((finite & !unsure & ties).count_ones());
                finite &= unsure;
            }
        }
        if finite.count_ones() > 1 {
            let answer = signs.conflicts_in_pairs(sites, simplices, group, q);
            if let Some((certain, unsure)) = answer {
                inside |= certain & finite;
                stages.double_double += u64::from((finite & !unsure).count_ones());
                finite &= unsure;
            }
        }
        while finite != 0 {
            let lane = finite.trailing_zeros();
            finite &= finite - 1;
            let simplex = &simplices[group[lane as usize] as usize];
            inside |= u32::from(self.holds(sites, simplex, q)) << lane;
        }
        inside
    }

    /// Returns true if q is in conflict with a ghost: strictly beyond its facet, or in the plane of the facet and in conflict with
    /// the simplex behind it. Compiled for any processor, so its filter does without fused multiplication, which would be
    /// a call here.
    fn beyond<S: Signs, R: Slot<4>>(
        &mut self,
        sites: &[Site],
        simplices: &[R],
        ghost: &R,
        place: usize,
        q: &Site,
    ) -> bool {
        let site = |i: usize| &sites[row(ghost.vertex(FACETS[place][i]))];
        let (a, b, c) = (site(0), site(1), site(2));
        if S::FILTERED {
            let corners = [less::<Separate>(a, q), less(b, q), less(c, q)];
            let (Real(det, _), Real(bound, _)) = orientation(corners);
            if det.abs() > bound {
                return det > 0.0;
            }
        }
        match self.orient([q, a, b, c]) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => {
                self.behind += 1;
                let behind = &simplices[(ghost.neighbor(place) >> 2) as usize];
                self.holds(sites, behind, q)
            }
        }
    }

    /// Returns true if q is in conflict with a finite simplex, whatever the filter says.
    fn holds(&mut self, sites: &[Site], simplex: &impl Slot<4>, q: &Site) -> bool {
        let [a, b, c, d] = rows(sites, simplex.vertices()).map(Site::point);
        space::conflict_exact(a, b, c, d, q.point(), &mut self.exact)
    }
}
