//! The paper's comparison: 75 quadratic elements beside 150 SE(3) elements, the same number of unknowns.

use std::error::Error;
use std::path::Path;

use cosserat::scene::{InterpolationKind, QuadratureKind};
use cosserat::solution::Row;
use nalgebra::Vector3;
use plotters::prelude::*;

use super::spring::{
    PRINTED_CURVE, PRINTED_CURVE_REASON, Spring, WIRE_END, WireEnd, places, printed, wire_end,
};
use crate::case::{Case, Checks, Kind, Outcome};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "spring_comparison::same_unknowns",
            "Harsch & Eugster, section 4.1 and Fig. 1",
            same_unknowns,
        )
        .slow()
        .reads(&[WIRE_END]),
        Case::new(
            "spring_comparison::se3_curve",
            "authors' program, 150 SE(3) elements, fit of 151 samples",
            se3_curve,
        )
        .slow()
        .reads(&[PRINTED]),
    ]
}

const PRINTED: &str = "authors/spring_se3.csv";

fn se3(force: f64) -> Spring {
    Spring { interpolation: InterpolationKind::Se3, ..Spring::new(force, 150, 1) }
}

/// Both curves are one line at the scale of Fig. 1, whose axis is 0.6 m long.
fn same_unknowns(checks: &mut Checks) -> Outcome {
    let line_width = 2.5e-3 * 0.6;
    let line = "one line of a printed figure: 1/400 of its axis of 0.6 m";
    let mut distances =
        ["R12 from SE(3)", "R12 from exact", "SE(3) from exact"].map(|name| (name, Points::new()));
    let loads = wire_end(checks)?;
    for (index, placement) in places().iter().enumerate() {
        for &WireEnd { force, exact, .. } in loads.iter().filter(|load| load.force >= 5.0) {
            let title = format!("{force} N, {}", placement.name);
            let exact = Vector3::from(exact);
            let quadratic = Spring::new(force, 75, 2).displacement(placement)?;
            let two_node = se3(force).displacement(placement)?;
            let apart = [quadratic - two_node, quadratic - exact, two_node - exact];
            for ((name, points), apart) in distances.iter_mut().zip(apart) {
                let quantity = format!("{name} [m], {title}");
                checks.below(Kind::Published, quantity, apart.norm(), line_width, line);
                if index == 0 {
                    points.push((force, 1e3 * apart.norm()));
                }
            }
            // Order 4 in 75 elements beats order 2 in 150 until the layers at the ends are thinner than an element.
            if force < 60.0 {
                checks.above(
                    Kind::Order,
                    format!("SE(3)'s error over R12's, {title}"),
                    (two_node - exact).norm() / (quadratic - exact).norm(),
                    1.0,
                    "order 4 against order 2 at 0.4 rad from node to node",
                );
            }
        }
    }
    plot(&crate::report::folder().join("spring_comparison.svg"), &loads, &distances)
}

/// The authors' SE(3) curve. Samples at the nodes alone: the fit has no residual, its nodes are on the curve.
///
/// It is that of *two* Gauss points, the full rule, which their program takes by default; the one point that
/// is the two-node element's own gives 79.553 / 150.227 / 272.469 / 499.805 / 572.560 mm.
fn se3_curve(checks: &mut Checks) -> Outcome {
    let printed = printed(checks, PRINTED)?;
    for placement in places() {
        for &[force, expected, digit] in &printed {
            let spring = Spring { quadrature: QuadratureKind::Full, ..se3(force) };
            checks.absolute(
                Kind::CrossCode,
                format!("u_z at {force} N [m], {}", placement.name),
                (spring.displacement(&placement)?.z, expected),
                PRINTED_CURVE + digit,
                PRINTED_CURVE_REASON,
            );
        }
    }
    Ok(())
}

type Points = Vec<(f64, f64)>;

/// F over u_z of both, the exact points, and how far apart they are at the exact loads.
fn plot(path: &Path, loads: &[WireEnd], distances: &[(&'static str, Points)]) -> Outcome {
    let [as_is, ..] = places();
    let curve = |spring: Spring| -> Result<Points, Box<dyn Error>> {
        let solution = spring.solve(&as_is)?;
        let start = solution.rows.first().ok_or("the solution has no rows")?.probes[0].position[2];
        let point = |row: &Row| (row.probes[0].position[2] - start, row.parameter * spring.force);
        Ok(solution.rows.iter().map(point).collect())
    };
    // The wide light line below, the thin dark one above: they are hard to tell apart otherwise.
    let curves = [
        ("R12, 75 quadratic elements", RGBColor(86, 180, 233).stroke_width(6), Spring::new(100.0, 75, 2)),
        ("SE(3), 150 two-node elements", RGBColor(0, 60, 110).stroke_width(2), se3(100.0)),
    ];
    std::fs::create_dir_all(path.parent().ok_or("a plot needs a directory")?)?;
    let area = SVGBackend::new(path, (1000, 450)).into_drawing_area();
    area.fill(&WHITE)?;
    let (left, right) = area.split_horizontally(520);
    let mut chart = ChartBuilder::on(&left)
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(52)
        .build_cartesian_2d(0.0..0.6, 0.0..105.0)?;
    chart.configure_mesh().disable_mesh().x_desc("displacement in z [m]").y_desc("force [N]").draw()?;
    for (name, style, spring) in curves {
        chart
            .draw_series(LineSeries::new(curve(spring)?, style))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], style));
    }
    let exact = loads.iter().map(|load| Circle::new((load.exact[2], load.force), 4, BLACK.filled()));
    chart.draw_series(exact)?.label("exact").legend(|(x, y)| Circle::new((x + 10, y), 4, BLACK.filled()));
    let corner = SeriesLabelPosition::UpperLeft;
    chart.configure_series_labels().position(corner).background_style(WHITE).draw()?;

    let mut chart = ChartBuilder::on(&right)
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..105.0, (1e-3..10.0).log_scale())?;
    chart.configure_mesh().disable_mesh().x_desc("force [N]").y_desc("distance of the tips [mm]").draw()?;
    let colours = [BLACK, RGBColor(86, 180, 233), RGBColor(0, 60, 110)];
    for ((name, points), colour) in distances.iter().zip(colours) {
        let style = colour.stroke_width(2);
        chart
            .draw_series(LineSeries::new(points.iter().copied(), style).point_size(3))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], style));
    }
    let corner = SeriesLabelPosition::LowerRight;
    chart.configure_series_labels().position(corner).background_style(WHITE).draw()?;
    area.present()?;
    Ok(())
}
