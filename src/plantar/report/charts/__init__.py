"""Charts as SVG inside the page: drawn without a script, in the page's colours, also on paper."""
