"""3MF: archives of XML, with build items, components and the production extension."""
