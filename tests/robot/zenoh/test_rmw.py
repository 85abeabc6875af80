"""Names on the wire of rmw_zenoh; the expected texts are those of its design document."""

import pytest

from robot.zenoh import cdr
from robot.zenoh.rmw import (
    NO_HASH,
    Quality,
    TopicType,
    attachment,
    node_token,
    publisher_id,
    reply_attachment,
    topic_of_token,
    topic_token,
)
from robot.zenoh.services import service_hash, trigger_hash, write_trigger_response

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
CHATTER = TopicType("/chatter", "std_msgs/msg/String", STRING_HASH, Quality(7))
TALKER = (
    "@ros2_lv/0/8b20917502ee955ac4476e0266340d5c/0/10/MP/%/%/talker/%chatter/"
    f"std_msgs::msg::dds_::String_/{STRING_HASH}/::,7:,:,:,,"
)


def test_key_of_a_topic() -> None:
    assert CHATTER.key(0) == f"0/chatter/std_msgs::msg::dds_::String_/{STRING_HASH}"
    assert CHATTER.any_key(2) == "2/chatter/std_msgs::msg::dds_::String_/*"
    nested = TopicType("/robot1/points", "std_msgs/msg/String", NO_HASH, Quality(1))
    assert nested.key(0) == "0/robot1/points/std_msgs::msg::dds_::String_/TypeHashNotSupported"


def test_hash_of_a_type_equals_that_of_ros() -> None:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    assert cdr.type_hash("std_msgs/msg/String") == STRING_HASH


def test_tokens_equal_those_of_ros() -> None:
    zid = "aac3178e146ba6f1fc6e6a4085e77f21"
    assert node_token(0, zid, "listener") == f"@ros2_lv/0/{zid}/0/0/NN/%/%/listener"
    zid = "8b20917502ee955ac4476e0266340d5c"
    assert topic_token(0, zid, "talker", "MP", 10, CHATTER) == TALKER


def test_quality_that_is_not_the_default_stands_in_the_token() -> None:
    assert str(Quality(5, best_effort=True)) == "2::,5:,:,:,,"
    assert str(Quality(1, transient_local=True)) == ":1:,1:,:,:,,"


def test_token_is_read() -> None:
    assert topic_of_token(TALKER) == ("MP", "/chatter", "std_msgs/msg/String")
    assert topic_of_token(node_token(0, "ab", "listener")) is None
    assert topic_of_token(TALKER.replace("MP", "SS")) is None


def test_attachment_has_33_bytes() -> None:
    publisher = publisher_id(TALKER)
    assert len(publisher) == 16
    assert publisher != publisher_id(TALKER.replace("/10/", "/11/"))
    expected = (3).to_bytes(8, "little") + (5).to_bytes(8, "little") + b"\x10" + publisher
    assert attachment(3, 5, publisher) == expected


def test_hash_of_a_service_equals_that_of_ros() -> None:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    request, response = "int64 a\nint64 b\n", "int64 sum\n"
    # The example of rmw_zenoh's design document.
    assert service_hash("example_interfaces/srv/AddTwoInts", request, response) == (
        "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
    )
    assert trigger_hash() == (
        "RIHS01_eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f"
    )


def test_response_of_a_trigger_is_cdr() -> None:
    # Header, success with padding, length with the zero, text.
    expected = "00010000" + "01000000" + "03000000" + b"ok\0".hex()
    assert write_trigger_response(True, "ok").hex() == expected


def test_response_names_the_request_of_its_client() -> None:
    client = publisher_id(TALKER)
    assert reply_attachment(attachment(7, 1, client), 5) == attachment(7, 5, client)
    for other in (None, b"", bytes(33), b"x" * 33):
        assert reply_attachment(other, 5) == attachment(0, 5, bytes(16))
