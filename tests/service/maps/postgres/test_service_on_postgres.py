"""Some tests of the service once more, with the maps in PostgreSQL.

All tests of the service run so with `PLACECELL_TEST_STORE=postgres pytest tests/service`.
"""

import pytest

from tests.service.maps.test_history import (
    files,
    test_changes_of_a_compacted_version_are_gone,
    test_every_version_is_listed_and_served,
    test_restore_makes_a_version_that_can_be_undone,
)
from tests.service.maps.test_segments import (
    edit,
    test_concurrent_edits_lose_nothing,
    test_edit_adds_replaces_and_removes_at_once,
    test_edits_survive_a_restart,
    test_reserved_ids_are_given_out_once,
    yard,
)

__all__ = [
    "edit",
    "files",
    "test_changes_of_a_compacted_version_are_gone",
    "test_concurrent_edits_lose_nothing",
    "test_edit_adds_replaces_and_removes_at_once",
    "test_edits_survive_a_restart",
    "test_every_version_is_listed_and_served",
    "test_reserved_ids_are_given_out_once",
    "test_restore_makes_a_version_that_can_be_undone",
    "yard",
]

pytestmark = pytest.mark.integration


@pytest.fixture(autouse=True)
def on_postgres(postgres_database: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keeps the maps of the test in a database of its own."""
    monkeypatch.setenv("PLACECELL_DATABASE", postgres_database)
