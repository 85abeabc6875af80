"""Write the generated parts of docs/reference: `python -m cli.reference`, `make reference`."""

from cli.reference.pages import PAGES, generate


def main() -> None:
    """Write every page whose generated parts changed."""
    for page in PAGES:
        before, after = generate(page)
        if after != before:
            page.write_text(after, encoding="utf-8")
            print(f"Page {page.name} is updated.")


if __name__ == "__main__":
    main()
