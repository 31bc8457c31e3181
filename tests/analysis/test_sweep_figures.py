from analysis.estimate import Estimate
from analysis.sweep_figures import draw
from analysis.sweep_table import Point, SweepTable


def test_there_is_a_panel_for_each_number_and_no_empty_one() -> None:
    for count in (1, 3, 4):
        names = [f"number_{n}" for n in range(count)]
        points = [
            Point({"gravity": g}, ["run"], {name: Estimate(g, 0.1) for name in names})
            for g in (0.1, 0.2)
        ]
        rows = [point.row(names) for point in points]
        table = SweepTable(points, rows, 2, 2, [], ("gravity",), tuple(names))
        figure = draw(table)
        assert figure
        shown = [axes for axes in figure.axes if axes.axison]
        assert [axes.get_title() for axes in shown] == [n.replace("_", " ") for n in names]
