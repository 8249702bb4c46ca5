// Drawing of image.h, dot by dot.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "algorithm/image/image.h"

using namespace sgs;

namespace {

// Rows of the picture: '#' where something is drawn.
std::vector<std::string> drawn(const Image& image) {
  std::vector<std::string> rows;
  for (int y = 0; y < image.height; ++y) {
    rows.emplace_back();
    for (int x = 0; x < image.width; ++x) rows.back() += image.at(x, y) == glm::vec3(0) ? '.' : '#';
  }
  return rows;
}

using Rows = std::vector<std::string>;

}  // namespace

TEST_CASE("drawing: text is drawn dot by dot and cut to the picture") {
  struct Case {
    std::string text;
    int x, y, dot_px;
    Rows rows;
  };
  const std::vector<Case> cases = {
      {"1.4%",
       0,
       0,
       1,
       {".#......#.#.#.#", "##......#.#...#", ".#......###..#.", ".#........#.#..",
        "###..#....#.#.#"}},
      {"Ee", 0, 0, 1, {"###.###", "#...#..", "##..##.", "#...#..", "###.###"}},
      {"7?-", 0, 0, 1, {"###........", "..#........", ".#......###", ".#.........", ".#........."}},
      {"7",
       0,
       0,
       2,
       {"######", "######", "....##", "....##", "..##..", "..##..", "..##..", "..##..", "..##..",
        "..##.."}},
      {"T", -1, 2, 1, {"...", "...", "##.", "#..", "#.."}},
      {"", 0, 0, 1, {"..", ".."}},
  };
  for (const Case& c : cases) {
    Image image(static_cast<int>(c.rows.front().size()), static_cast<int>(c.rows.size()));
    draw_text(image, c.x, c.y, c.dot_px, c.text, glm::vec3(1));
    CAPTURE(c.text);
    CHECK(drawn(image) == c.rows);
  }
}

TEST_CASE("drawing: every letter, digit and sign has a shape of its own") {
  const std::string characters = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ.%-+<";
  std::vector<Rows> shapes = {drawn(Image(3, 5))};
  for (const char c : characters) {
    Image image(text_dots(1), kGlyphRows);
    draw_text(image, 0, 0, 1, std::string(1, c), glm::vec3(1));
    CAPTURE(c);
    for (const Rows& other : shapes) CHECK(drawn(image) != other);
    shapes.push_back(drawn(image));
  }
}

TEST_CASE("drawing: rectangles are cut to the picture") {
  Image image(4, 3);
  fill_rect(image, -2, 1, 4, 9, glm::vec3(1));
  fill_rect(image, 3, -5, 9, 6, glm::vec3(1));
  fill_rect(image, 2, 2, 0, 1, glm::vec3(1));
  CHECK(drawn(image) == Rows{"...#", "##..", "##.."});
}
