//! The Pareto front: settings that no other beats in both time and error.

/// Indices of the points `[seconds, error]` than which no other is both as quick and as accurate, and better in one; by time.
/// Of equal points the first. Points that are not finite are on no front.
pub fn pareto_front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| points[i].iter().all(|v| v.is_finite())).collect();
    order.sort_by(|&a, &b| points[a][0].total_cmp(&points[b][0]).then(points[a][1].total_cmp(&points[b][1])));
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i][1] < least;
        least = least.min(points[i][1]);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_beaten_is_not_on_the_front() {
        let points = [[3.0, 0.1], [1.0, 0.5], [2.0, 0.6], [2.0, 0.2], [2.0, 0.2], [4.0, 0.1], [f64::NAN, 0.0]];
        assert_eq!(pareto_front(&points), [1, 3, 0], "beaten, equal and not a number are left out");
        assert!(pareto_front(&[]).is_empty());
    }
}
