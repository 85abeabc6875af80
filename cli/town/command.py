"""`placecell town`: simulates drives through a synthetic town."""

import json
import time

import typer

from cli.sources import clear_errors, show
from cli.tables import write_json
from cli.town import options
from cli.town.large import pairs_of, planned


def town(
    context: typer.Context,
    output: options.Output,
    seed: options.Seed = 7,
    place: options.Place = "streets",
    floor: options.Floor = 0,
    differing: options.Differing = 0.3,
    scans: options.Scans = None,
    spacing: options.Spacing = None,
    overwrite: options.Overwrite = False,
    sensor: options.Sensor = "hdl-64e",
    mount: options.Mount = None,
    columns: options.Columns = None,
    rain: options.Rain = 0.0,
    dropout: options.Dropout = None,
    speed: options.Speed = None,
    distortion: options.Distortion = False,
    labels: options.Labels = False,
    meters: options.Meters = None,
    look_alikes: options.LookAlikes = 0.25,
    route: options.RouteText = "all",
    start: options.Start = 0.0,
    robots: options.Robots = 2,
    lane: options.Lane = 1.6,
    oncoming: options.Oncoming = 10.0,
    yaw_drift: options.YawDrift = 0.05,
    scale_drift: options.ScaleDrift = 0.01,
    pairs: options.Pairs = 0,
    pair_meters: options.PairMeters = 300.0,
    picture: options.Picture = None,
    json_file: options.JsonFile = None,
) -> None:
    """Simulate robots that drive the same streets of a synthetic town in opposite directions.

    --place simulates another place: a campus, a garden, an indoor floor or a car park.

    The command writes OUTPUT/robot_a and OUTPUT/robot_b in the KITTI odometry layout. Parked
    cars change between the drives. The same seed gives the same files. --sensor selects the LiDAR:

        placecell town out/town16 --sensor vlp-16 --mount 0.5

    With --meters the town is large, and each drive has a second pose file, poses_odometry.txt, with
    drifting odometry. This example has 5 km of streets; each street is driven in both directions:

        placecell town out/town5 --meters 5000 --picture out/town5.png

    A scan of hdl-64e takes about 1 MB and 25 ms. See docs/explanation/town.md.
    """
    with clear_errors():
        import town as simulation

        lidar = simulation.sensor(sensor, columns=columns, mount=mount, rain=rain, dropout=dropout)
        if meters is None:
            refuse_options_of_large_towns(context)
            drives = simulation.two_robots(
                output,
                seed=seed,
                place=place,
                floor=floor,
                differing=differing,
                scans=scans or options.SCANS,
                spacing=spacing,
                lidar=lidar,
                mount=mount,
                speed=speed,
                distortion=distortion,
                labels=labels,
                overwrite=overwrite,
                progress=show,
            )
            for drive in drives:
                typer.echo(f"Drive {drive} has {scans or options.SCANS} scans.")
            return
        if place != "streets":
            raise ValueError(f"--meters builds streets only; leave out --place {place}.")
        spacing = 1.0 if spacing is None else spacing
        if pairs and robots < 2:
            raise ValueError("--pairs needs two robots or more; increase --robots")
        city = simulation.City.build(seed, meters, look_alikes)
        way = city.route(planned(city, route), lane)
        # Draw the pairs before the simulation, because there may be none.
        drawn = (
            pairs_of(city, way, scans, spacing, start, pairs, pair_meters, lidar.height)
            if pairs
            else None
        )
        started = time.perf_counter()
        driven = simulation.several_robots(
            output,
            city,
            way,
            robots,
            start=start,
            scans=scans,
            spacing=spacing,
            lidar=lidar,
            odometry=simulation.Odometry(yaw_drift, scale_drift),
            oncoming=oncoming,
            speed=speed,
            distortion=distortion,
            labels=labels,
            overwrite=overwrite,
            progress=show,
        )
        figures = {
            "seed": seed,
            "street_metres": round(city.network.meters(), 1),
            "streets": len(city.network.streets),
            "route_metres": round(way.length(), 1),
            "scans": {drive.name: len(list((drive / "velodyne").iterdir())) for drive in driven},
            "seconds": round(time.perf_counter() - started, 1),
        }
        if drawn:
            write_json(drawn, output / "pairs.json")
        if picture:
            from town.drives.picture import draw_plan

            draw_plan(picture, city, way, driven)
        write_json(figures, json_file)
    typer.echo(json.dumps(figures))


def refuse_options_of_large_towns(context: typer.Context) -> None:
    """Refuse options that have no effect in the small town.

    Raises:
        ValueError: an option of the large town was given.
    """
    for parameter in context.command.params:
        source = context.get_parameter_source(str(parameter.name))
        given = source is not None and source.name == "COMMANDLINE"
        if given and getattr(parameter, "rich_help_panel", None) == options.LARGE:
            raise ValueError(f"{parameter.opts[0]} needs a large town: give --meters too")
