//! Polylines in the plane of the sheet.

/// A point of the sheet [px], y downwards.
pub type Point = [f64; 2];

/// The polyline without the points that change it by less than the tolerance
/// (Ramer 1972; Douglas & Peucker 1973).
pub fn simplify(points: &[Point], tolerance: f64) -> Vec<Point> {
    let (Some(first), Some(last)) = (points.first(), points.len().checked_sub(1)) else {
        return Vec::new();
    };
    let mut kept = vec![false; points.len()];
    kept[0] = true;
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let distances = (from + 1..to).map(|k| (k, distance(points[k], points[from], points[to])));
        let farthest = distances.max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, far)) = farthest
            && far > tolerance
        {
            kept[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    // The end of a polyline that shrank to one point is that point again.
    kept[last] |= kept[1..].contains(&true) || distance(points[last], *first, *first) > tolerance;
    let pairs = points.iter().zip(kept);
    pairs.filter_map(|(point, kept)| kept.then_some(*point)).collect()
}

/// Distance of a point from the segment between two others.
fn distance(point: Point, a: Point, b: Point) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let t =
        if square > 0.0 { ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (from[0] - t * along[0]).hypot(from[1] - t * along[1])
}

/// The pieces of the polyline that a dash pattern draws: lengths drawn and left out, alternating, all positive.
pub fn dashed(points: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let mut lengths = pattern.iter().copied().cycle();
    let (mut left, mut drawn) = (lengths.next().unwrap_or(f64::INFINITY), true);
    let mut pieces = Vec::new();
    let mut piece: Vec<Point> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let mut passed = 0.0;
        while passed + left < length {
            passed += left;
            let t = passed / length;
            let here = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
            if drawn {
                piece.push(here);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![here];
            }
            drawn = !drawn;
            left = lengths.next().unwrap_or(f64::INFINITY);
        }
        left -= length - passed;
        if drawn {
            piece.push(b);
        }
    }
    if piece.len() > 1 {
        pieces.push(piece);
    }
    pieces
}

/// A curve from left to right with at most four points in every column of the given width: where it enters and
/// leaves, and its lowest and highest point.
pub fn thinned(points: &[Point], column: f64) -> Vec<Point> {
    let index = |point: &Point| (point[0] / column).floor();
    let mut kept = Vec::new();
    for group in points.chunk_by(|a, b| index(a) == index(b)) {
        let height = |k: &usize| group[*k][1];
        let all = || 0..group.len();
        let lowest = all().min_by(|a, b| height(a).total_cmp(&height(b)));
        let highest = all().max_by(|a, b| height(a).total_cmp(&height(b)));
        let mut chosen: Vec<usize> =
            [Some(0), lowest, highest, group.len().checked_sub(1)].into_iter().flatten().collect();
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|k| group[k]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_points_that_matter_stay() {
        let straight: Vec<Point> = (0..1000).map(|k| [k as f64, 2.0 * k as f64]).collect();
        assert_eq!(simplify(&straight, 0.1), [[0.0, 0.0], [999.0, 1998.0]]);
        let corner = [[0.0, 0.0], [1.0, 0.05], [5.0, 0.0], [5.0, 5.0]];
        assert_eq!(simplify(&corner, 0.1), [[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]]);
        let circle: Vec<Point> = (0..=2000)
            .map(|k| (k as f64 * std::f64::consts::TAU / 2000.0).sin_cos())
            .map(|(sine, cosine)| [100.0 * cosine, 100.0 * sine])
            .collect();
        let few = simplify(&circle, 0.1);
        assert!(few.len() > 30 && few.len() < 200, "{}", few.len());
        let off = |point: &Point| {
            few.windows(2).map(|pair| distance(*point, pair[0], pair[1])).fold(f64::INFINITY, f64::min)
        };
        assert!(circle.iter().all(|point| off(point) <= 0.1));
    }

    #[test]
    fn a_curve_without_extent_is_a_point() {
        assert_eq!(simplify(&[], 0.1), [] as [Point; 0]);
        assert_eq!(simplify(&[[1.0, 2.0]], 0.1), [[1.0, 2.0]]);
        assert_eq!(simplify(&[[1.0, 2.0]; 50], 0.1), [[1.0, 2.0]]);
    }

    #[test]
    fn a_column_keeps_what_shows() {
        let wave: Vec<Point> =
            (0..100_000).map(|k| k as f64 / 1000.0).map(|x| [x, (7.0 * x).sin()]).collect();
        let few = thinned(&wave, 0.5);
        assert!(few.len() <= 4 * 200 && few.len() > 200);
        assert!(few.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        assert_eq!((few[0], few[few.len() - 1]), (wave[0], wave[wave.len() - 1]));
        let highest =
            |points: &[Point]| points.iter().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max);
        assert_eq!(highest(&few), highest(&wave));
        assert_eq!(thinned(&[], 0.5), [] as [Point; 0]);
    }

    #[test]
    fn dashes_follow_the_corner() {
        let pieces = dashed(&[[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]], &[2.0, 0.5]);
        let wanted: [&[Point]; 3] =
            [&[[0.0, 0.0], [2.0, 0.0]], &[[2.5, 0.0], [3.0, 0.0], [3.0, 1.5]], &[[3.0, 2.0], [3.0, 4.0]]];
        assert_eq!(pieces, wanted);
    }
}
