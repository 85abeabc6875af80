"""The PostgreSQL server of the tests."""

from tests.service.postgres_server import PostgresServer


def test_each_test_has_an_empty_database(
    postgres_server: PostgresServer, postgres_database: str
) -> None:
    tables = "SELECT count(*) FROM information_schema.tables WHERE table_schema = 'public'"
    assert postgres_server.execute(tables, postgres_database) == [(0,)]
    postgres_server.execute("CREATE TABLE theirs (a int)", postgres_database)
    assert postgres_server.execute(tables, postgres_database) == [(1,)]
    other = postgres_server.create_database()
    assert postgres_server.execute(tables, other) == [(0,)]
    postgres_server.drop_database(other)


def test_killed_server_keeps_its_data(
    postgres_server: PostgresServer, postgres_database: str
) -> None:
    postgres_server.execute("CREATE TABLE theirs (a int)", postgres_database)
    postgres_server.kill()
    postgres_server.start()
    assert postgres_server.execute("SELECT count(*) FROM theirs", postgres_database) == [(0,)]
