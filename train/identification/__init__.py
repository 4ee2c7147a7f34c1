"""What an identification found, as files: the plant, plants within its spread, a report and its figures."""
