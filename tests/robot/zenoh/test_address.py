import pytest

from robot.zenoh.address import ZenohAddress


def test_address_without_a_host_is_the_router_of_ros() -> None:
    address = ZenohAddress.of("zenoh://")
    assert address == ZenohAddress(connect=("tcp/localhost:7447",))
    assert (address.points, address.odom, address.domain) == ("/points", "/odom", 0)


def test_host_gets_the_default_port() -> None:
    assert ZenohAddress.of("zenoh://robot.local").connect == ("tcp/robot.local:7447",)
    assert ZenohAddress.of("zenoh://[::1]").connect == ("tcp/[::1]:7447",)
    assert ZenohAddress.of("zenoh://10.0.0.7:9000").connect == ("tcp/10.0.0.7:9000",)


def test_address_that_listens_connects_to_nothing() -> None:
    address = ZenohAddress.of("zenoh://?listen=tcp/0.0.0.0:7447&listen=udp/0.0.0.0:7447")
    assert address.connect == ()
    assert address.listen == ("tcp/0.0.0.0:7447", "udp/0.0.0.0:7447")


def test_topics_and_names_are_set_by_keys() -> None:
    address = ZenohAddress.of(
        "zenoh://h?points=/velodyne/points&odom=/odometry&domain=7&map_frame=site&distro=humble"
    )
    assert (address.points, address.odom) == ("/velodyne/points", "/odometry")
    assert (address.domain, address.map_frame, address.distro) == (7, "site", "humble")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("tcp://h", "Invalid address 'tcp://h': expected zenoh://HOST:PORT"),
        ("zenoh://h?clouds=/points", "Unknown key 'clouds' .* expected diagnostics, distro"),
        ("zenoh://h?connect=tcp/h:1", "Unknown key 'connect'"),
        ("zenoh://h?points=points", "Invalid points 'points' .* the absolute name of a topic"),
        ("zenoh://h?points=", "Invalid points ''"),
        ("zenoh://h?domain=300", "Invalid domain '300' .* a number from 0 to 232"),
        ("zenoh://h?listen=7447", "Invalid listen '7447' .* such as tcp/0.0.0.0:7447"),
        ("zenoh://h?node=a/b", "Invalid node 'a/b' .* letters, digits and underscores"),
    ],
)
def test_invalid_addresses_are_refused(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ZenohAddress.of(text)
