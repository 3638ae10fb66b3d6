#include "gallery/page.hpp"

#include <fmt/format.h>

namespace surfgrad::gallery {
namespace {

constexpr std::string_view style = R"css(
:root { color-scheme: dark; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem clamp(1rem, 4vw, 3rem) 4rem; max-width: 84rem;
  background: #18191b; color: #d6d7d9; font: 1rem/1.5 system-ui, sans-serif; }
h1 { margin: 0 0 .5rem; font-size: 1.8rem; color: #f2f2f3; }
h2 { margin: 0 0 .4rem; font-size: 1.3rem; color: #f2f2f3; }
p { max-width: 65ch; margin: 0 0 1rem; }
a { color: #9cc3e6; }
nav ul { columns: 20rem; padding: 0; list-style: none; }
section { padding-top: 2.5rem; }
.panels { display: grid; gap: 1.25rem; grid-template-columns: repeat(auto-fill, minmax(min(100%, 20rem), 1fr)); }
figure { margin: 0; background: #222326; border-radius: 4px; overflow: hidden; }
figure img { display: block; width: 100%; height: auto; }
figcaption { padding: .7rem .9rem .9rem; font-size: .93rem; }
figcaption strong { color: #f2f2f3; }
.way { float: right; margin-left: .6rem; padding: 0 .5em; border-radius: 3px; font-size: .8rem; }
.right { background: #244a33; color: #a8e0ba; }
.older { background: #4a3d20; color: #e9cf94; }
.wrong { background: #53292b; color: #f0aeb0; }
)css";

struct Badge {
  std::string_view name; // class and, spelled out, text
  std::string_view text;
};

Badge badge_of(Way way) {
  switch (way) {
  case Way::right:
    return {"right", "right"};
  case Way::older:
    return {"older", "older way"};
  case Way::wrong:
    return {"wrong", "wrong"};
  case Way::choice:
    break;
  }
  return {};
}

std::string panel_html(const Figure& figure, const Panel& panel, int width, int height) {
  const std::string picture = escaped(picture_name(figure, panel));
  const Badge badge = badge_of(panel.way);
  std::string html = fmt::format(R"(<figure>
<a href="{0}"><img src="{0}" alt="{1}: {2}" width="{3}" height="{4}" loading="lazy"></a>
<figcaption>)",
                                 picture, escaped(figure.title), escaped(panel.label), width, height);
  if (!badge.name.empty()) html += fmt::format(R"(<span class="way {}">{}</span>)", badge.name, badge.text);
  html += fmt::format("<strong>{}</strong><br>\n{}</figcaption>\n</figure>\n", escaped(panel.label),
                      escaped(panel.look));
  return html;
}

} // namespace

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '&')
      html += "&amp;";
    else if (c == '<')
      html += "&lt;";
    else if (c == '>')
      html += "&gt;";
    else if (c == '"')
      html += "&quot;";
    else if (c == '\'')
      html += "&#39;";
    else
      html += c;
  }
  return html;
}

std::string page(const std::vector<Figure>& figures, int width, int height) {
  std::string html = fmt::format(R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>surfgrad gallery</title>
<style>{}</style>
</head>
<body>
<h1>Every kind of bump</h1>
<p>Each bump becomes a surface gradient: a vector in the tangent plane that can be scaled, masked, added and
mixed. One step turns the sum into a normal. The pictures show what that gives, beside older ways and
mistakes where there are any. The surfaces are never displaced unless a caption says so: what you see is
shading.</p>
<nav><ul>
)",
                                 style);
  for (const Figure& figure : figures)
    html += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", escaped(figure.id), escaped(figure.title));
  html += "</ul></nav>\n";
  for (const Figure& figure : figures) {
    html += fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n<p>{}</p>\n<div class=\"panels\">\n",
                        escaped(figure.id), escaped(figure.title), escaped(figure.caption));
    for (const Panel& panel : figure.panels) html += panel_html(figure, panel, width, height);
    html += "</div>\n</section>\n";
  }
  html += "</body>\n</html>\n";
  return html;
}

} // namespace surfgrad::gallery
