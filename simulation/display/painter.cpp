#include "painter.h"

#include <GL/freeglut.h>

namespace musclesim {

namespace {

void* font() {
  return GLUT_BITMAP_9_BY_15;
}

constexpr float font_height_px = 19, ascent_px = 14;

}  // namespace

BitmapPainter::BitmapPainter(int width, int height) {
  glMatrixMode(GL_PROJECTION);
  glPushMatrix();
  glLoadIdentity();
  glOrtho(0, width, height, 0, -1, 1);
  glMatrixMode(GL_MODELVIEW);
  glPushMatrix();
  glLoadIdentity();
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

BitmapPainter::~BitmapPainter() {
  glDisable(GL_BLEND);
  glPopMatrix();
  glMatrixMode(GL_PROJECTION);
  glPopMatrix();
}

void BitmapPainter::rectangle(float x, float y, float width, float height, const Color& color, float alpha) {
  glColor4f(static_cast<float>(color.red), static_cast<float>(color.green), static_cast<float>(color.blue), alpha);
  glRectf(x, y, x + width, y + height);
}

void BitmapPainter::text(float x, float y, const std::string& text, const Color& color) {
  glColor4f(static_cast<float>(color.red), static_cast<float>(color.green), static_cast<float>(color.blue), 1);
  glRasterPos2f(x, y + ascent_px);
  glutBitmapString(font(), reinterpret_cast<const unsigned char*>(text.c_str()));
}

float BitmapPainter::widthOf(const std::string& text) const {
  return static_cast<float>(glutBitmapLength(font(), reinterpret_cast<const unsigned char*>(text.c_str())));
}

float BitmapPainter::lineHeight() const {
  return font_height_px;
}

}  // namespace musclesim
